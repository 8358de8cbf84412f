// TOML files of gates.
#include "eval/compare/gates.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

void gates(std::string_view bytes) {
  const auto read = compare::parse_gates(bytes, "gates.toml");
  if (!read) return check_error(read.error(), "gates.toml");
  check(read->alpha > 0 && read->alpha < 1 && read->min_repetitions > 0,
        "limits of the test are in their ranges");
  for (const double factor : read->factors) check(factor >= 1, "a factor is at least 1");
}

}  // namespace fusebench::fuzz
