#include "datasets/simulator/layouts/layout.hpp"

#include <array>
#include <cmath>

#include "core/base/mesh/ply_file.hpp"
#include "datasets/recording/reading/time_unit.hpp"
#include "datasets/simulator/layouts/write_lists.hpp"

namespace fusebench::simulator::layouts {

namespace {

SE3 same_world(const SimulatedData&) { return {}; }

// TUM: seconds since 1970 with six decimals. ICL-NUIM: no clock, frame k is at k / 30 s. ZR300: microseconds
// since the start, with images from 0.75 s after the start of the IMU. Readers of the ZR300 derive the unit
// of the stamps from their spacing, so image intervals must be within kImageSpacing (time_unit.hpp).
constexpr std::array<LayoutDescription, 3> kLayouts = {{
    {"tum", 1'600'000'000'000'000'000, 250'000'000, 1000, true, true, 1, 240, sensors::DepthNoise::handa,
     tum_color_name, tum_depth_name, write_tum_lists, same_world},
    {"icl", 0, 250'000'000, 1, false, false, 30, 30, sensors::DepthNoise::handa, icl_color_name,
     icl_depth_name, write_icl_lists, icl_T_file_scene},
    {"zr300", 755'000'000, 750'000'000, 1000, true, false, 1 / reading::kImageSpacing.most_s,
     1 / reading::kImageSpacing.least_s, sensors::DepthNoise::zr300, zr300_color_name, zr300_depth_name,
     write_zr300_lists, same_world},
}};

Mesh moved(Mesh mesh, const SE3& T_file_scene) {
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = (T_file_scene * Vector3d(vertex.cast<double>())).cast<float>();
  }
  const Eigen::Quaternionf rotation = T_file_scene.rotation.cast<float>();
  for (Eigen::Vector3f& normal : mesh.normals) normal = rotation * normal;
  return mesh;
}

}  // namespace

std::string_view to_string(RecordingLayout layout) { return describe(layout).name; }

const LayoutDescription& describe(RecordingLayout layout) {
  return kLayouts[static_cast<std::size_t>(layout)];
}

std::int64_t LayoutDescription::frame_ns(std::size_t frame, double rate_hz) const {
  const double since_first_s = static_cast<double>(frame) / rate_hz;
  return first_frame_ns + std::llround(1e9 * since_first_s / static_cast<double>(tick_ns)) * tick_ns;
}

Result<void> write_layout(RecordingLayout layout, const std::filesystem::path& folder,
                          const SimulatedData& data) {
  const LayoutDescription& description = describe(layout);
  const SE3 T_file_scene = description.T_file_scene(data);
  if (auto written = description.write_lists(folder, data); !written) return written;
  if (auto written = write_text(folder / "calibration.toml", calibration::to_toml(data.rig)); !written)
    return written;
  if (auto written = write_states(folder / "state_groundtruth.csv", data.imu.states, T_file_scene); !written)
    return written;
  return mesh::write_ply(moved(data.scene, T_file_scene), folder / "scene.ply");
}

}  // namespace fusebench::simulator::layouts
