#include "eval/page/series_colours.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "eval/page/page.hpp"

namespace fusebench::page {

namespace {

/// Of variants: those that are often beside each other differ.
constexpr std::size_t kOwnColours = 10;

}  // namespace

std::vector<std::size_t> series_colours(std::span<const ColouredName> names) {
  std::vector<std::size_t> order(names.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return names[i].rank; });
  std::map<std::string, std::size_t> colours;
  std::set<std::size_t> taken;
  for (const std::size_t i : order) {
    if (colours.contains(names[i].name)) continue;
    const std::size_t own = names[i].rank % kOwnColours;
    std::size_t colour = own;
    for (std::size_t k = 0; k + 1 < kSeriesColours; ++k) {
      colour = (own + k) % (kSeriesColours - 1);
      if (!taken.contains(colour)) break;
    }
    taken.insert(colour);
    if (taken.size() == kSeriesColours - 1) taken.clear();
    colours[names[i].name] = colour + 1;
  }
  std::vector<std::size_t> result;
  for (const ColouredName& name : names) result.push_back(colours.at(name.name));
  return result;
}

}  // namespace fusebench::page
