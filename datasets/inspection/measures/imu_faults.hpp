// Samples of an IMU that are faults of the sensor or its driver: everything that is fitted leaves them out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::inspection::measures {

/// One component of one sample.
struct ImuFault {
  std::size_t sample = 0;
  Vector3d ImuSample::*sensor = nullptr;
  Eigen::Index axis = 0;
  double value = 0;
};

/// A spike: one or two samples in a row whose value jumps away from those on both sides and back, by more
/// than 5 rad/s or 50 m/s^2 and by more than ten times what neighbouring samples differ. Or a value that no
/// sensor of a hand-held rig measures (70 rad/s, 1000 m/s^2), if these are few; if they are many, the unit is
/// wrong, which other checks report. In order of the samples, one component each: the one that is farthest
/// off.
[[nodiscard]] std::vector<ImuFault> find_imu_faults(std::span<const ImuSample> samples);

/// "the gyroscope's x reads 100 rad/s at 1305031102.175304000 (sample 412)".
[[nodiscard]] std::string describe(const ImuFault& fault, std::span<const ImuSample> samples);

/// The other samples.
[[nodiscard]] std::vector<ImuSample> without_faults(std::span<const ImuSample> samples,
                                                    std::span<const ImuFault> faults);

}  // namespace fusebench::inspection::measures
