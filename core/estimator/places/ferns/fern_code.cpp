#include "core/estimator/places/ferns/fern_code.hpp"

#include <cmath>

namespace fusebench::ferns {

void pass(FernCode& code, std::size_t test) {
  std::uint8_t& fern = code[test / kTestsOfFern];
  fern = static_cast<std::uint8_t>(fern | (1U << (test % kTestsOfFern)));
}

double dissimilarity(const FernCode& a, const FernCode& b) {
  std::size_t different = 0;
  for (std::size_t fern = 0; fern < kFerns; ++fern) different += a[fern] != b[fern] ? 1U : 0U;
  return static_cast<double>(different) / static_cast<double>(kFerns);
}

double uniform(std::mt19937_64& generator) {
  constexpr int kUnusedBits = 11;  // a double holds 53 of the 64
  return std::ldexp(static_cast<double>(generator() >> kUnusedBits), -53);
}

}  // namespace fusebench::ferns
