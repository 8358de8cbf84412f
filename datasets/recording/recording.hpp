// The one interface of all recordings: metadata, lists, and a function that loads one frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/estimator/filter/stamped_state.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::recording {

/// Where inertial samples come from; printed in every record and table.
enum class ImuSource { none, recorded, synthetic };
[[nodiscard]] std::string_view to_string(ImuSource source);  ///< "none", "recorded", "synthetic IMU"

/// Label of a ground truth made by `fusebench smooth`: in its first line and in records.
inline constexpr std::string_view kPseudoGroundTruth =
    "pseudo ground truth: batch estimate of the same recording, not independent";

struct FrameEntry {
  std::int64_t timestamp_ns = 0;        ///< colour image
  std::int64_t depth_timestamp_ns = 0;  ///< associated depth image
  std::int64_t capture_ns = 0;          ///< instant of the colour image: its stamp without jitter
  std::int64_t depth_capture_ns =
      0;  ///< instant of the depth image: without jitter, the sensor's delay applied
  std::filesystem::path color_file;
  std::filesystem::path depth_file;
};

/// A sample of an accelerometer that comes without a gyroscope, in its own axes.
struct AccelerometerSample {
  std::int64_t timestamp_ns = 0;
  Vector3d specific_force_mps2 = Vector3d::Zero();
};

/// An opened recording. All lists are checked and sorted by time when it is opened; images are read on
/// demand.
struct Recording {
  std::string name;         ///< folder name
  std::string format;       ///< as datasets/open_recording.cpp names it: "tum", "icl"
  std::string fingerprint;  ///< content hash of all lists and image files that are used (hex)
  bool simulated = false;   ///< made by a simulator: its truth and IMU are, too
  SensorRig rig;            ///< of the undistorted images
  std::vector<FrameEntry> frames;
  std::size_t whole_frames = 0;  ///< of the whole recording where `frames` is a part of it; 0: it is not
  std::vector<ImuSample> imu;    ///< empty if imu_source is none
  ImuSource imu_source = ImuSource::none;
  std::string imu_note;  ///< for a synthetic IMU: how it was made (sensor, seed, fit residuals)
  std::vector<AccelerometerSample>
      accelerometer;  ///< TUM's Kinect; not an IMU (no gyroscope), no estimator uses it
  std::vector<StampedPose>
      ground_truth;  ///< T_groundtruth_camera: colour camera in the ground truth's own world; may be empty
  std::string truth_label;  ///< begins with "pseudo ground truth" and says whose estimate ground_truth is,
                            ///< e.g. kPseudoGroundTruth; empty where it is independent of the images
  std::optional<calibration::RigCalibration> calibration;  ///< as read, before undistortion; of what files
                                                           ///< say, not of a synthetic IMU; with the
                                                           ///< format's scale of depth where nobody says it
  std::vector<std::string> notes;     ///< what was done to the data on reading, for the run's log
  std::vector<std::string> warnings;  ///< for the user (unmatched images, gaps)
  /// Loads, checks, undistorts one frame. Safe to call from several threads. Errors: data_missing,
  /// data_corrupt.
  std::function<Result<RgbdFrame>(std::size_t frame)> load_frame;
  std::vector<filter::StampedState> state_truth;  ///< of the recorded IMU, on the images' clock; may be empty
  std::filesystem::path truth_mesh_file;  ///< the scene, in the ground truth's world; empty if there is none
};

/// A recording with its name (that of the folder) and format set, and nothing else.
[[nodiscard]] Recording named_recording(const std::filesystem::path& folder, std::string_view format);

/// Of the colour camera in the body whose poses ground_truth gives: the calibration's. Zero for pseudo ground
/// truth and for that of simulations, which are of the camera itself, whatever camera it is read as.
[[nodiscard]] Vector3d ground_truth_offset_m(const Recording& recording);

/// Replaces the timing of the image sensors; depth images are taken that much later or earlier.
void set_timing(Recording& recording, const SensorTiming& timing);

/// Keeps frames begin to end - 1 (which become 0 to end - begin - 1); IMU and ground truth stay whole. A part
/// of a recording gets its own fingerprint. Errors: usage (an empty range, or one that leaves the recording).
[[nodiscard]] Result<void> select_frames(Recording& recording, std::size_t begin, std::size_t end);

}  // namespace fusebench::recording
