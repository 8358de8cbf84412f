#include "core/trajectory/association.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace fusebench::trajectory {

namespace {
struct Candidate {
  std::int64_t difference_ns = 0;
  std::size_t first = 0;
  std::size_t second = 0;
};
}  // namespace

std::vector<AssociatedPair> associate(std::span<const std::int64_t> first_ns,
                                      std::span<const std::int64_t> second_ns, std::int64_t max_difference_ns,
                                      std::int64_t offset_ns) {
  std::vector<Candidate> candidates;
  std::size_t window = 0;  // the first entry of second_ns that is not too early; only moves forward
  for (std::size_t a = 0; a < first_ns.size(); ++a) {
    const std::int64_t wanted_ns = first_ns[a] - offset_ns;
    while (window < second_ns.size() && wanted_ns - second_ns[window] >= max_difference_ns) ++window;
    for (std::size_t b = window; b < second_ns.size() && second_ns[b] - wanted_ns < max_difference_ns; ++b) {
      candidates.push_back({std::abs(wanted_ns - second_ns[b]), a, b});
    }
  }
  std::ranges::sort(candidates, {},
                    [](const Candidate& c) { return std::tuple(c.difference_ns, c.first, c.second); });

  std::vector<bool> first_used(first_ns.size());
  std::vector<bool> second_used(second_ns.size());
  std::vector<AssociatedPair> pairs;
  for (const Candidate& c : candidates) {
    if (first_used[c.first] || second_used[c.second]) continue;
    first_used[c.first] = true;
    second_used[c.second] = true;
    pairs.push_back({c.first, c.second});
  }
  std::ranges::sort(pairs, {}, &AssociatedPair::first);
  return pairs;
}

}  // namespace fusebench::trajectory
