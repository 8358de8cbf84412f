#include "eval/compare/aggregate/option_bins.hpp"

#include <fmt/format.h>

#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "eval/record/run_files/option_order.hpp"

namespace fusebench::aggregate {

namespace {

/// The different numbers of an option; nothing if one of its values is none.
std::optional<std::vector<double>> numbers_of(std::span<const RunRow> rows, const std::string& key) {
  std::set<double> numbers;
  for (const RunRow& row : rows) {
    for (const auto& [name, value] : row.options) {
      if (name != key) continue;
      const auto number = run_files::option_number(value);
      if (!number) return std::nullopt;
      numbers.insert(*number);
    }
  }
  return std::vector<double>(numbers.begin(), numbers.end());
}

/// The name of the bin of each number.
std::map<double, std::string> bins_of(const std::vector<double>& numbers, std::size_t bins) {
  std::map<double, std::string> names;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(bin * numbers.size() / bins);
    const auto end = numbers.begin() + static_cast<std::ptrdiff_t>((bin + 1) * numbers.size() / bins);
    const double mean = std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
    for (auto number = begin; number != end; ++number) names.emplace(*number, fmt::format("{:.3g}", mean));
  }
  return names;
}

}  // namespace

std::vector<RunRow> with_binned_options(std::span<const RunRow> rows, std::size_t most, std::size_t bins) {
  std::vector<RunRow> binned(rows.begin(), rows.end());
  for (const std::string& key : edited_options(rows)) {
    const auto numbers = numbers_of(rows, key);
    if (!numbers || numbers->size() <= most) continue;
    const auto names = bins_of(*numbers, bins);
    for (RunRow& row : binned) {
      for (auto& [name, value] : row.options) {
        if (name == key) value = names.at(*run_files::option_number(value));
      }
    }
  }
  return binned;
}

}  // namespace fusebench::aggregate
