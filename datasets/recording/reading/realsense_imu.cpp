#include "datasets/recording/reading/realsense_imu.hpp"

#include "core/base/error.hpp"
#include "datasets/calibration/recording_catalogue.hpp"

namespace fusebench::reading {

ImuNoise realsense_imu_noise() {
  const auto calibration = calibration::catalogue_calibration("zr300_fmdataset");
  check(calibration.has_value() && calibration->imu.has_value(), "the catalogue holds a ZR300's IMU");
  return calibration->imu->noise;
}

}  // namespace fusebench::reading
