// Published calibrations of the TUM RGB-D cameras, and cameras written on a command line.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::calibration {

struct CameraPreset {
  std::string_view name;
  std::string_view sentence;
  CalibratedCamera camera;
};

/// freiburg1, freiburg2, freiburg3 (Sturm et al., IROS 2012, the calibration on the data set's page) and
/// default.
[[nodiscard]] std::span<const CameraPreset> camera_presets();

/// A preset's name, or "fx,fy,cx,cy" or "fx,fy,cx,cy,k1,k2,p1,p2,k3" in pixels (the size is that of the
/// images). Error: configuration.
[[nodiscard]] Result<CalibratedCamera> parse_camera(std::string_view text);

/// The preset whose name occurs in a folder's name ("rgbd_dataset_freiburg1_rpy"); never "default".
[[nodiscard]] std::optional<CalibratedCamera> camera_by_folder_name(std::string_view folder_name);

}  // namespace fusebench::calibration
