// Options of reading: properties of a recording that its files do not hold.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "datasets/calibration/camera_model.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::recording {

/// Of most cameras.
inline constexpr double kUsualFrameRate_hz = 30;

[[nodiscard]] inline bool is_frame_rate(double rate_hz) { return rate_hz >= 1 && rate_hz <= 1000; }

/// Each reader uses those that apply to its format.
struct ReadOptions {
  std::optional<calibration::RigCalibration>
      calibration;  ///< takes the place of calibration.toml and of published ones
  std::optional<calibration::CalibratedCamera>
      camera;                                   ///< of the colour images; overrides every other calibration
  std::optional<double> depth_units_per_metre;  ///< value of one metre in the depth images
  double max_difference_s = 0.02;  ///< between a colour image and its depth image, for formats with two lists
  bool regular_stamps = true;      ///< remove the jitter of the stamps (see regular_stamps.hpp)
  /// Of recordings without stamps (ICL-NUIM); else what their files say, else kUsualFrameRate_hz.
  std::optional<double> frame_rate_hz;
  bool filtered_depth = false;  ///< take the depth that the recording's authors have filtered
};

/// Errors: configuration (an option out of range).
[[nodiscard]] Result<void> check_read_options(const ReadOptions& options);

/// The calibration of a recording: the options', else calibration.toml in its folder, else what `published`
/// gives; the options'
/// camera and depth scale replace those parts. Where it comes from goes into recording.notes. Errors: those
/// of `published` (only called when it is needed) and of calibration.toml.
[[nodiscard]] Result<calibration::RigCalibration> choose_calibration(
    const std::filesystem::path& folder, const ReadOptions& options,
    const std::function<Result<calibration::RigCalibration>()>& published, Recording& recording);

}  // namespace fusebench::recording
