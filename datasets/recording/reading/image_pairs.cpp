#include "datasets/recording/reading/image_pairs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/reading/regular_stamps.hpp"

namespace fusebench::reading {

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
std::vector<std::int64_t> capture_times(const ImageTimes& images, const recording::ReadOptions& options,
                                        recording::Recording& recording) {
  std::vector<std::int64_t> recorded(images.times_ns.begin(), images.times_ns.end());
  if (!options.regular_stamps) return recorded;
  auto regular = regular_stamps(recorded);
  if (!regular || regular->jitter_max_s < kNoJitter_s) return recorded;
  recording.notes.push_back(
      fmt::format("{}: stamps jitter by {:.1f} ms rms (at most {:.1f} ms) and were made regular", images.name,
                  1e3 * regular->jitter_rms_s, 1e3 * regular->jitter_max_s));
  return std::move(regular->capture_ns);
}

}  // namespace

Result<std::vector<trajectory::AssociatedPair>> pair_times(const ImageTimes& color, const ImageTimes& depth,
                                                           const recording::ReadOptions& options,
                                                           recording::Recording& recording) {
  const std::int64_t max_difference_ns = std::llround(1e9 * options.max_difference_s);
  auto pairs = trajectory::associate(color.times_ns, depth.times_ns, max_difference_ns);
  if (pairs.empty()) {
    const auto range = [](const ImageTimes& images) {
      return images.times_ns.empty()
                 ? std::string("none")
                 : fmt::format("times {} to {}", trajectory::stamp_text(images.times_ns.front()),
                               trajectory::stamp_text(images.times_ns.back()));
    };
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: no colour image ({}) has a depth image ({}) within {} s", recording.name,
                            range(color), range(depth), options.max_difference_s),
                fmt::format("{} and {} must be of one recording and one clock", color.name, depth.name));
  }
  const std::vector<std::int64_t> color_ns = capture_times(color, options, recording);
  const std::vector<std::int64_t> depth_ns = capture_times(depth, options, recording);
  for (const trajectory::AssociatedPair& pair : pairs) {
    recording.frames.push_back({color.times_ns[pair.first],
                                depth.times_ns[pair.second],
                                color_ns[pair.first],
                                depth_ns[pair.second],
                                {},
                                {}});
  }
  if (pairs.size() < color.times_ns.size() || pairs.size() < depth.times_ns.size()) {
    recording.warnings.push_back(fmt::format(
        "{}: {} of {} colour and {} of {} depth images have no partner within {} s and are not used",
        recording.name, color.times_ns.size() - pairs.size(), color.times_ns.size(),
        depth.times_ns.size() - pairs.size(), depth.times_ns.size(), options.max_difference_s));
  }
  return pairs;
}

void make_stamps_regular(std::string_view list, const recording::ReadOptions& options,
                         recording::Recording& recording) {
  std::vector<std::int64_t> color_ns;
  std::vector<std::int64_t> depth_ns;
  for (const recording::FrameEntry& frame : recording.frames) {
    color_ns.push_back(frame.timestamp_ns);
    depth_ns.push_back(frame.depth_timestamp_ns);
  }
  const std::string color_name = fmt::format("{}, colour", list);
  const std::string depth_name = fmt::format("{}, depth", list);
  color_ns = capture_times({color_name, color_ns}, options, recording);
  depth_ns = capture_times({depth_name, depth_ns}, options, recording);
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    recording.frames[k].capture_ns = color_ns[k];
    recording.frames[k].depth_capture_ns = depth_ns[k];
  }
}

Result<void> pair_images(const ImageList& color, const ImageList& depth,
                         const recording::ReadOptions& options, recording::Recording& recording) {
  const std::vector<std::int64_t> color_ns = stamps(color.images);
  const std::vector<std::int64_t> depth_ns = stamps(depth.images);
  const auto pairs = pair_times({color.name, color_ns}, {depth.name, depth_ns}, options, recording);
  if (!pairs) return tl::unexpected(pairs.error());
  auto frame = recording.frames.end() - std::ssize(*pairs);
  for (const trajectory::AssociatedPair& pair : *pairs) {
    frame->color_file = color.images[pair.first].file;
    frame->depth_file = depth.images[pair.second].file;
    ++frame;
  }
  return {};
}

}  // namespace fusebench::reading
