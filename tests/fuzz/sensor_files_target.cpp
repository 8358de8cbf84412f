// Descriptions of cameras and poses: YAML, matrices as text, and Record3D's JSON.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/recording/formats/open_loris/transforms.hpp"
#include "datasets/recording/formats/record3d/record3d_metadata.hpp"
#include "datasets/recording/reading/sensor_yaml.hpp"
#include "datasets/recording/reading/text_matrix.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace reading;

namespace {

void check_pose(const SE3& pose) {
  check(pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-9,
        "a pose is rigid and finite");
}

void check_yaml(const std::filesystem::path& file) {
  const auto yaml = SensorYaml::read(file);
  if (!yaml) return check_error(yaml.error(), file);
  for (const YamlValue& value : yaml->values()) {
    check(yaml->has(value.key) && value.line > 0, "a value is found by its key");
    const auto numbers = yaml->numbers(value.key, value.items.size());
    if (numbers)
      check(std::ranges::all_of(*numbers, [](double n) { return std::isfinite(n); }), "numbers are finite");
  }
  const auto frames = formats::open_loris::read_transforms(file);
  if (!frames) return check_error(frames.error(), file);
  if (const auto T = frames->transform("base_link", "d400_color_optical_frame")) check_pose(*T);
}

void check_matrices(const std::filesystem::path& file) {
  const auto pose = read_pose_matrix(file);
  if (!pose) {
    check_error(pose.error(), file);
  } else if (*pose) {
    check_pose(**pose);
  }
  const auto camera = read_camera_matrix(file);
  if (!camera) return check_error(camera.error(), file);
  check(camera->fx_px > 0 && camera->fy_px > 0, "focal lengths are positive");
}

void check_metadata(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  const auto metadata = formats::record3d::read_record3d_metadata(file, warnings);
  if (!metadata) return check_error(metadata.error(), file);
  check(metadata->camera.width_px > 0 && metadata->camera.fx_px > 0, "a camera has a size");
  check(std::ranges::is_sorted(metadata->timestamps_ns), "time rises");
  for (const SE3& pose : metadata->T_world_camera) check_pose(pose);
}

}  // namespace

void sensor_files(std::string_view bytes) {
  static const MemoryFile file("sensor.yaml");
  file.write(bytes);
  check_yaml(file.path());
  check_matrices(file.path());
  check_metadata(file.path());
}

}  // namespace fusebench::fuzz
