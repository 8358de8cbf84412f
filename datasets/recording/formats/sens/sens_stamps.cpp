#include "datasets/recording/formats/sens/sens_stamps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/upper_median.hpp"
#include "datasets/recording/reading/time_unit.hpp"

namespace fusebench::formats::sens {

namespace {

double median_spacing(std::span<const std::uint64_t> stamps, const std::vector<std::size_t>& frames) {
  std::vector<double> spacings;
  for (std::size_t i = 1; i < frames.size(); ++i)
    spacings.push_back(static_cast<double>(stamps[frames[i]] - stamps[frames[i - 1]]));
  return upper_median(std::move(spacings));
}

/// A first or last stamp that is far from all others rises, too.
void leave_out_far_ends(std::span<const std::uint64_t> stamps, double spacing,
                        std::vector<std::size_t>& frames) {
  constexpr double kFar = 100;
  const auto is_far = [&](std::size_t first, std::size_t second) {
    return static_cast<double>(stamps[second] - stamps[first]) > kFar * spacing;
  };
  if (frames.size() > 2 && is_far(frames[0], frames[1])) frames.erase(frames.begin());
  if (frames.size() > 2 && is_far(frames[frames.size() - 2], frames.back())) frames.pop_back();
}

}  // namespace

bool enough_rise(std::size_t rising, std::size_t all) { return rising >= 2 && 3 * rising >= 2 * all; }

std::vector<std::size_t> rising_stamps(std::span<const std::uint64_t> stamps) {
  // The longest increasing subsequence: ends[n] has the least last stamp of those of n + 1 frames.
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> ends;
  std::vector<std::size_t> before(stamps.size(), kNone);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const auto at =
        std::ranges::lower_bound(ends, stamps[k], {}, [&](std::size_t frame) { return stamps[frame]; });
    if (at != ends.end() && stamps[*at] == stamps[k]) continue;  // the first of equals
    if (at != ends.begin()) before[k] = *(at - 1);
    if (at == ends.end()) {
      ends.push_back(k);
    } else {
      *at = k;
    }
  }
  std::vector<std::size_t> frames;
  for (std::size_t k = ends.empty() ? kNone : ends.back(); k != kNone; k = before[k]) frames.push_back(k);
  std::ranges::reverse(frames);
  return frames;
}

ImageStamps image_stamps(std::span<const std::uint64_t> stamps) {
  ImageStamps result;
  const auto refuse = [&](std::string reason) {
    result.reason = std::move(reason);
    return result;
  };
  if (std::ranges::all_of(stamps, [](std::uint64_t stamp) { return stamp == 0; }))
    return refuse("the .sens file has no stamps");
  std::vector<std::size_t> frames = rising_stamps(stamps);
  if (!enough_rise(frames.size(), stamps.size()))
    return refuse(fmt::format("the stamps of the .sens file are not used, since only {} of {} rise",
                              frames.size(), stamps.size()));
  const double spacing = median_spacing(stamps, frames);
  const auto unit = reading::unit_of_spacing(spacing, reading::kImageSpacing);
  if (!unit)
    return refuse(
        fmt::format("the stamps of the .sens file are not used, since a spacing of {} is not that of "
                    "images in s, ms, us or ns",
                    spacing));
  leave_out_far_ends(stamps, spacing, frames);
  const auto factor = std::llround(std::pow(10.0, static_cast<int>(unit->unit)));
  if (stamps[frames.back()] >
      static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 4 / factor))
    return refuse("the stamps of the .sens file are not used, since they are too large");
  result.unit_ns = factor;
  result.frames = std::move(frames);
  return result;
}

}  // namespace fusebench::formats::sens
