#include "eval/metrics/trajectory_error/streamed_statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fusebench::trajectory_error {

namespace {

constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
constexpr int kDigitBits = 16;
constexpr std::uint64_t kDigits = std::uint64_t{1} << kDigitBits;

/// Bit patterns in the order of the values.
std::uint64_t key_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

double value_of(std::uint64_t key) { return std::bit_cast<double>((key & kSign) != 0 ? key & ~kSign : ~key); }

/// The value of a rank, found from its highest digit on: one digit after each pass over all values.
class RankSearch {
 public:
  void count(std::uint64_t key) {
    if ((key & known_) == key_) ++counts_[(key >> shift_) % kDigits];
  }

  /// After a pass.
  void descend() {
    std::uint64_t digit = 0;
    while (digit + 1 < kDigits && rank_ >= counts_[digit]) rank_ -= counts_[digit++];
    key_ |= digit << shift_;
    known_ |= (kDigits - 1) << shift_;
    shift_ -= kDigitBits;
    std::ranges::fill(counts_, 0);
  }

  void set_rank(std::uint64_t rank) { rank_ = rank; }
  [[nodiscard]] double value() const { return value_of(key_); }

 private:
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kDigits, 0);
  std::uint64_t key_ = 0;
  std::uint64_t known_ = 0;  ///< the digits that are
  std::uint64_t rank_ = 0;   ///< among the values with these digits
  int shift_ = 64 - kDigitBits;
};

}  // namespace

metrics::Statistics streamed_statistics(const ValueSource& source) {
  metrics::Statistics result;
  RankSearch below;  // of the two middle values; the same if their count is odd
  RankSearch above;
  const auto count = [&](double value) {
    const std::uint64_t key = key_of(value);
    below.count(key);
    above.count(key);
  };
  const auto descend = [&] {
    below.descend();
    above.descend();
  };

  double sum = 0;
  double sse = 0;
  source([&](double value) {
    if (result.count == 0) result.min = result.max = value;
    ++result.count;
    sum += value;
    sse += value * value;
    result.min = std::min(result.min, value);
    result.max = std::max(result.max, value);
    count(value);
  });
  if (result.count == 0) return result;
  const double n = static_cast<double>(result.count);
  result.sse = sse;
  result.mean = sum / n;
  result.rmse = std::sqrt(sse / n);
  below.set_rank((result.count - 1) / 2);
  above.set_rank(result.count / 2);
  descend();

  double squares = 0;
  source([&](double value) {
    squares += (value - result.mean) * (value - result.mean);
    count(value);
  });
  result.std = std::sqrt(squares / n);
  descend();
  for (int pass = 2; pass < 64 / kDigitBits; ++pass) {
    source(count);
    descend();
  }
  result.median = result.count % 2 == 1 ? above.value() : 0.5 * (below.value() + above.value());
  return result;
}

}  // namespace fusebench::trajectory_error
