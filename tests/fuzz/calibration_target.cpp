// TOML, and the calibration of a recording's sensors written in it.
#include <cmath>

#include "datasets/calibration/rig_calibration.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace config;
using namespace calibration;

namespace {

void check_rigid(const SE3& T) {
  check(T.translation.allFinite() && std::abs(T.rotation.norm() - 1) < 1e-9,
        "a transform is rigid and finite");
}

void check_pinhole(const PinholeCamera& camera) {
  check(camera.width_px >= 0 && camera.height_px >= 0, "sizes are not negative");
  check((camera.width_px == 0) == (camera.height_px == 0), "a size is given whole or not at all");
  check(camera.fx_px > 0 && camera.fy_px > 0, "focal lengths are positive");
}

void check_calibration(const RigCalibration& calibration) {
  check_pinhole(calibration.color.pinhole);
  check(!calibration.depth_units_per_metre || *calibration.depth_units_per_metre > 0, "a scale is positive");
  if (calibration.depth) {
    check_pinhole(calibration.depth->pinhole);
    check_rigid(calibration.depth->T_color_depth);
  }
  if (calibration.imu) check_rigid(calibration.imu->T_imu_camera);
}

}  // namespace

void calibration(std::string_view bytes) {
  static const MemoryFile file("calibration.toml");
  file.write(bytes);
  if (const auto document = read_toml(file.path()); !document) check_error(document.error(), file.path());
  const auto read = read_calibration_beside(file.folder());
  if (!read) return check_error(read.error(), file.path());
  check(read->has_value(), "a file that is there is read");
  check_calibration(**read);
  const std::string text = to_toml(**read);
  file.write(text);
  const auto again = read_calibration_beside(file.folder());
  check(again && *again, "what is written reads back");
  check_calibration(**again);
}

}  // namespace fusebench::fuzz
