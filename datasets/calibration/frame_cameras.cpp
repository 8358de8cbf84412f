#include "datasets/calibration/frame_cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/upper_median.hpp"

namespace fusebench::calibration {

namespace {

constexpr double kNoChange = 0.005;  // 1.6 px at a distance of 320 px from the centre

double median_of(std::span<const FrameCamera> frames, double PinholeCamera::*parameter) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FrameCamera& frame : frames) values.push_back(frame.camera.*parameter);
  return upper_median(std::move(values));
}

}  // namespace

CommonCamera common_camera(std::span<const FrameCamera> frames) {
  check(!frames.empty(), "there is a frame");
  CommonCamera common{frames.front().camera, {}};
  for (const auto parameter :
       {&PinholeCamera::fx_px, &PinholeCamera::fy_px, &PinholeCamera::cx_px, &PinholeCamera::cy_px})
    common.camera.*parameter = median_of(frames, parameter);
  const auto [least, most] =
      std::ranges::minmax_element(frames, {}, [](const FrameCamera& frame) { return frame.camera.fx_px; });
  const double change = (most->camera.fx_px - least->camera.fx_px) / common.camera.fx_px;
  if (change < kNoChange) return common;
  common.change = fmt::format(
      "the focal length changes by {:.1f} % (from {:.1f} px in frame {} to {:.1f} px in frame {}); one "
      "camera "
      "is used for all frames, the median of {:.1f} px: lock the focus, or use a part of the recording",
      100 * change, least->camera.fx_px, least->frame, most->camera.fx_px, most->frame, common.camera.fx_px);
  return common;
}

}  // namespace fusebench::calibration
