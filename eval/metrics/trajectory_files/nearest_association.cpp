#include "eval/metrics/trajectory_files/nearest_association.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::trajectory_files {

namespace {

/// An entry of the longer list.
struct Entry {
  double time_s = 0;
  std::size_t index = 0;
};

/// By time, equal ones by index.
std::vector<Entry> entries_of(std::span<const std::int64_t> stamps_ns, double offset_s) {
  std::vector<Entry> entries;
  entries.reserve(stamps_ns.size());
  for (std::size_t i = 0; i < stamps_ns.size(); ++i)
    entries.push_back({stamp_seconds(stamps_ns[i]) + offset_s, i});
  if (!std::ranges::is_sorted(entries, {}, &Entry::time_s))
    std::ranges::stable_sort(entries, {}, &Entry::time_s);
  return entries;
}

/// The index of the nearest entry, the least of equally near ones.
std::optional<std::size_t> nearest_within(std::span<const Entry> entries, double wanted_s, double limit_s) {
  if (entries.empty()) return std::nullopt;
  const auto miss = [&](const Entry& entry) { return std::abs(entry.time_s - wanted_s); };
  const auto after = std::ranges::lower_bound(entries, wanted_s, {}, &Entry::time_s);
  auto best = after == entries.end() ? after - 1 : after;
  if (after != entries.begin()) {
    const auto before =
        std::ranges::lower_bound(entries.begin(), after, (after - 1)->time_s, {}, &Entry::time_s);
    const bool equal = miss(*before) == miss(*best);
    if (miss(*before) < miss(*best) || (equal && before->index < best->index)) best = before;
  }
  if (!(miss(*best) <= limit_s)) return std::nullopt;
  return best->index;
}

}  // namespace

std::vector<trajectory::AssociatedPair> associate_nearest(std::span<const std::int64_t> first_ns,
                                                          std::span<const std::int64_t> second_ns,
                                                          double max_difference_s, double offset_s) {
  const bool first_drives = first_ns.size() < second_ns.size();
  // The offset goes to the longer list, with its sign, as evo has it: rounding decides at the limit.
  const std::vector<Entry> longer =
      first_drives ? entries_of(second_ns, offset_s) : entries_of(first_ns, -offset_s);
  const std::span<const std::int64_t> driving = first_drives ? first_ns : second_ns;
  std::vector<trajectory::AssociatedPair> pairs;
  for (std::size_t k = 0; k < driving.size(); ++k) {
    const auto found = nearest_within(longer, stamp_seconds(driving[k]), max_difference_s);
    if (!found) continue;
    pairs.push_back(first_drives ? trajectory::AssociatedPair{k, *found}
                                 : trajectory::AssociatedPair{*found, k});
  }
  return pairs;
}

}  // namespace fusebench::trajectory_files
