// From lists of image files to frames: what all formats that store images have in common.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/reading/image_source.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// How the files of a recording become frames.
struct ImageDecoding {
  /// Colour and registered depth are undistorted; depth of a camera of its own is registered to the colour
  /// camera.
  calibration::RigCalibration calibration;
  DepthReader read_depth;
  std::string identity;  ///< names the way depth is read ("png 5000"), for the fingerprint
};

/// The scale of depth by which a recording is read: what the calibration says, else that of the format, which
/// the calibration says from then on.
[[nodiscard]] double settled_depth_units(calibration::RigCalibration& calibration,
                                         double published_units_per_metre);

/// Where depth shows colour's view in another number of pixels (an iPhone's): its camera is that of colour,
/// scaled, unless the calibration has one.
void complete_depth_camera(calibration::RigCalibration& calibration, const images::ImageSize& color,
                           const images::ImageSize& depth);

/// Completes a recording whose frames, truth and inertial samples are in place: checks the sizes of the first
/// images and the values of the calibration (calibration_checks.hpp), sets rig (camera, timing, IMU), applies
/// the delay of depth and the offset of the IMU's clock, takes the fingerprint (every used image is read
/// once), and provides load_frame, which refuses an image whose bytes are no longer those of the fingerprint.
/// Errors: data_missing, data_corrupt.
[[nodiscard]] Result<void> attach_images(recording::Recording& recording, const ImageDecoding& decoding);

/// The same for images that come from `source`; calibration and identity as above.
[[nodiscard]] Result<void> attach_images(recording::Recording& recording,
                                         const calibration::RigCalibration& calibration,
                                         const std::string& identity, const ImageSource& source);

/// The same for colour and depth in PNGs. published_units_per_metre: of the format, where the calibration
/// says nothing.
[[nodiscard]] Result<recording::Recording> with_png_images(recording::Recording recording,
                                                           calibration::RigCalibration calibration,
                                                           double published_units_per_metre);

}  // namespace fusebench::reading
