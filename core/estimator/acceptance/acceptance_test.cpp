#include "core/estimator/acceptance/acceptance_test.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fusebench::acceptance {

namespace {

bool passes(const AcceptanceTest& test) {
  if (!test.value) return true;
  return test.bound == Bound::at_least ? *test.value >= test.limit : *test.value <= test.limit;
}

}  // namespace

std::string first_failure(std::span<const AcceptanceTest> tests) {
  const auto failed = std::ranges::find_if_not(tests, passes);
  if (failed == tests.end()) return {};
  std::string text = fmt::format("{}: {:.3g}, allowed {} {:.4g}", failed->quantity, *failed->value,
                                 failed->bound == Bound::at_least ? "at least" : "at most", failed->limit);
  if (!failed->option.empty()) text += fmt::format(" ({})", failed->option);
  return text;
}

}  // namespace fusebench::acceptance
