// calib.txt, InfiniTAM's calibration.
#include "datasets/calibration/infinitam_calibration.hpp"

#include <cmath>

#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace calibration;

namespace {

void check_rigid(const SE3& T) {
  check(T.translation.allFinite() && std::abs(T.rotation.norm() - 1) < 1e-9,
        "a transform is rigid and finite");
}

}  // namespace

void infinitam(std::string_view bytes) {
  static const MemoryFile file("calib.txt");
  file.write(bytes);
  const auto calibration = read_infinitam_calibration(file.path());
  if (!calibration) return check_error(calibration.error(), file.path());
  check(calibration->depth && calibration->depth_units_per_metre, "depth is calibrated");
  check(std::isfinite(*calibration->depth_units_per_metre) && *calibration->depth_units_per_metre > 0,
        "a scale is positive");
  for (const PinholeCamera& camera : {calibration->color.pinhole, calibration->depth->pinhole}) {
    check(camera.fx_px > 0 && camera.fy_px > 0 && camera.width_px > 0 && camera.height_px > 0,
          "a camera has positive focal lengths and a size");
  }
  check_rigid(calibration->depth->T_color_depth);
  if (calibration->imu) check_rigid(calibration->imu->T_imu_camera);
}

}  // namespace fusebench::fuzz
