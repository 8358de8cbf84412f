// Depth against colour: where depth jumps, something ends, and its image mostly changes there, too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/inspection/checks.hpp"

namespace fusebench::inspection {

namespace {

std::string proposal(const calibration::DepthCamera& camera) {
  const Vector3d& depth_in_color_m = camera.T_color_depth.translation;
  return fmt::format(
      "a depth camera of {:.0f} px with centre ({:.0f}, {:.0f}), {:.0f} mm {} of colour and {:.0f} mm {}",
      camera.pinhole.fx_px, camera.pinhole.cx_px, camera.pinhole.cy_px, std::abs(1e3 * depth_in_color_m.x()),
      depth_in_color_m.x() < 0 ? "left" : "right", std::abs(1e3 * depth_in_color_m.y()),
      depth_in_color_m.y() < 0 ? "above" : "below");
}

}  // namespace

void check_registration(const recording::Recording& recording, const Workers& workers, Inspection& out) {
  // Depth at a wrong scale is also misregistered, and is reported already.
  if (out.images.empty() || out.has("depth-range") || out.has("depth-scale")) return;
  const auto fit = measures::fit_registration(recording, workers);
  if (!fit) return;
  out.registration = fit;
  if (!fit->is_determined()) return;
  // Points of one frame that are warped into another have the depth camera's focal length as well.
  for (Finding& finding : out.findings) {
    if (finding.code == "focal-length")
      finding.hint =
          "correct the depth camera first (depth-misregistered): it may be its focal length that is wrong";
  }
  out.add("depth-misregistered", Severity::warning,
          fmt::format("edges of depth are {:.0f} px from those of colour; {} would align them", fit->moved_px,
                      proposal(fit->fitted)),
          "check [depth] and T_color_depth in calibration.toml, and that depth is registered; `fusebench "
          "calibrate RECORDING --depth-camera` estimates the depth camera");
}

}  // namespace fusebench::inspection
