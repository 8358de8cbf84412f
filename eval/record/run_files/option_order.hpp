// The order of values of options that are kept as text.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace fusebench::run_files {

/// Key and value text of options, by key.
using RunOptions = std::vector<std::pair<std::string, std::string>>;

/// The number that the whole text is.
[[nodiscard]] inline std::optional<double> option_number(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Numbers by value, before texts by alphabet.
struct OptionValueLess {
  using is_transparent = void;
  [[nodiscard]] bool operator()(std::string_view a, std::string_view b) const {
    if (a == b) return false;
    const auto number_a = option_number(a);
    const auto number_b = option_number(b);
    if (number_a && number_b && *number_a != *number_b) return *number_a < *number_b;
    if (number_a.has_value() != number_b.has_value()) return number_a.has_value();
    return a < b;
  }
};

/// By the first difference: of keys, then of values; fewer options come first.
struct RunOptionsLess {
  [[nodiscard]] bool operator()(const RunOptions& a, const RunOptions& b) const {
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
      if (a[i].first != b[i].first) return a[i].first < b[i].first;
      if (a[i].second != b[i].second) return OptionValueLess()(a[i].second, b[i].second);
    }
    return a.size() < b.size();
  }
};

}  // namespace fusebench::run_files
