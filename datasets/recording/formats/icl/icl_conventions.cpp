#include "datasets/recording/formats/icl/icl_conventions.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "datasets/calibration/recording_catalogue.hpp"

namespace fusebench::formats::icl {

SE3 icl_reflect(const SE3& T_world_camera) {
  const Quaterniond& q = T_world_camera.rotation;
  const Vector3d& t = T_world_camera.translation;
  return {Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

calibration::RigCalibration icl_calibration() {
  auto calibration = calibration::catalogue_calibration("icl_nuim");
  check(calibration.has_value(), "the catalogue holds the calibration of ICL-NUIM");
  calibration->depth_units_per_metre.reset();  // that of the PNGs; .depth files have another
  return *std::move(calibration);
}

}  // namespace fusebench::formats::icl
