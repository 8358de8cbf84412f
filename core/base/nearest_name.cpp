#include "core/base/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace fusebench {
inline namespace base {

namespace {
/// Damerau's distance (deletion, insertion, replacement, transposition of neighbours), computed row by row.
/// of_a_part: distance to the most similar substring of b.
std::size_t edit_distance(std::string_view a, std::string_view b, bool of_a_part = false) {
  std::vector<std::size_t> row(b.size() + 1);
  if (!of_a_part) std::iota(row.begin(), row.end(), std::size_t{0});
  std::vector<std::size_t> row_before;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::vector<std::size_t> next(row.size(), i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = row[j] + (a[i] == b[j] ? 0 : 1);
      next[j + 1] = std::min({next[j] + 1, row[j + 1] + 1, substituted});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        next[j + 1] = std::min(next[j + 1], row_before[j - 1] + 1);
    }
    row_before = std::exchange(row, std::move(next));
  }
  return of_a_part ? *std::ranges::min_element(row) : row[b.size()];
}

std::string_view without_dashes(std::string_view flag) {
  return flag.substr(std::min(flag.find_first_not_of('-'), flag.size()));
}

bool are_alike(std::string_view a, std::string_view b) {
  constexpr std::size_t kShortest = 3;  // least number of letters of a meaningful substring
  a = without_dashes(a);
  b = without_dashes(b);
  if (a.size() > b.size()) std::swap(a, b);
  if (2 * edit_distance(a, b) <= b.size()) return true;
  return a.size() >= kShortest && 3 * edit_distance(a, b, true) < a.size();
}

bool begins_with(std::string_view name, std::string_view beginning) {
  constexpr std::size_t kShortest = 2;
  return without_dashes(beginning).size() >= kShortest && name.starts_with(beginning);
}
}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string_view> names) {
  std::string_view best;
  // A prefix is preferred: an incomplete name is more likely than a misspelling of another, shorter name.
  std::pair<bool, std::size_t> best_rank;
  for (const std::string_view candidate : names) {
    const bool begun = begins_with(candidate, name);
    const std::pair<bool, std::size_t> rank(!begun, edit_distance(name, candidate));
    if (!best.empty() && rank >= best_rank) continue;
    if (!begun && !are_alike(name, candidate)) continue;
    best_rank = rank;
    best = candidate;
  }
  return std::string(best);
}

std::string nearest_hint(std::string_view name, std::span<const std::string_view> names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : " (nearest: " + nearest + ")";
}

std::string nearest_hint(std::string_view name, const std::vector<std::string>& names) {
  return nearest_hint(name, std::vector<std::string_view>(names.begin(), names.end()));
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : "did you mean " + nearest + "?";
}

}  // namespace base
}  // namespace fusebench
