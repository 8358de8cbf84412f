#include "datasets/formats/tum/image_pairs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/trajectory/association.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "datasets/reading/regular_stamps.hpp"

namespace fusebench::formats::tum {

namespace {

// Less than this is the rounding of stamps that are regular already.
constexpr double kNoJitter_s = 1e-4;

std::vector<std::int64_t> stamps(std::span<const ListedImage> images) {
  std::vector<std::int64_t> result;
  result.reserve(images.size());
  for (const ListedImage& image : images) result.push_back(image.timestamp_ns);
  return result;
}

/// Capture times of the images of a list. The removed jitter is noted, since it changes the prediction by an
/// IMU.
std::vector<std::int64_t> capture_times(const ImageList& list, const recording::ReadOptions& options,
                                        recording::Recording& recording) {
  std::vector<std::int64_t> recorded = stamps(list.images);
  if (!options.regular_stamps) return recorded;
  auto regular = reading::regular_stamps(recorded);
  if (!regular || regular->jitter_max_s < kNoJitter_s) return recorded;
  recording.notes.push_back(
      fmt::format("{}: stamps jitter by {:.1f} ms rms (at most {:.1f} ms) and were made regular", list.name,
                  1e3 * regular->jitter_rms_s, 1e3 * regular->jitter_max_s));
  return std::move(regular->capture_ns);
}

}  // namespace

Result<void> pair_images(const ImageList& color, const ImageList& depth,
                         const recording::ReadOptions& options, recording::Recording& recording) {
  const std::int64_t max_difference_ns = std::llround(1e9 * options.max_difference_s);
  const auto pairs = trajectory::associate(stamps(color.images), stamps(depth.images), max_difference_ns);
  if (pairs.empty()) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: no colour image (times {} to {}) has a depth image (times {} to {}) within {} s",
                    recording.name, trajectory::stamp_text(color.images.front().timestamp_ns),
                    trajectory::stamp_text(color.images.back().timestamp_ns),
                    trajectory::stamp_text(depth.images.front().timestamp_ns),
                    trajectory::stamp_text(depth.images.back().timestamp_ns), options.max_difference_s),
        fmt::format("{} and {} must be of one recording and one clock", color.name, depth.name));
  }
  const std::vector<std::int64_t> color_ns = capture_times(color, options, recording);
  const std::vector<std::int64_t> depth_ns = capture_times(depth, options, recording);
  for (const trajectory::AssociatedPair& pair : pairs) {
    const ListedImage& c = color.images[pair.first];
    const ListedImage& d = depth.images[pair.second];
    recording.frames.push_back(
        {c.timestamp_ns, d.timestamp_ns, color_ns[pair.first], depth_ns[pair.second], c.file, d.file});
  }
  if (pairs.size() < color.images.size() || pairs.size() < depth.images.size()) {
    recording.warnings.push_back(fmt::format(
        "{}: {} of {} colour and {} of {} depth images have no partner within {} s and are not used",
        recording.name, color.images.size() - pairs.size(), color.images.size(),
        depth.images.size() - pairs.size(), depth.images.size(), options.max_difference_s));
  }
  return {};
}

}  // namespace fusebench::formats::tum
