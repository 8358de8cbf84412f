#include "eval/report/model_scene.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/base/mesh/ply_file.hpp"
#include "eval/metrics/mesh_error/error_colors.hpp"
#include "eval/metrics/mesh_error/mesh_clustering.hpp"
#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "eval/metrics/mesh_error/surfel_discs.hpp"
#include "eval/page/figures.hpp"
#include "eval/page/image_source.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/report/model_picture.hpp"
#include "eval/report/narrowed_image.hpp"

namespace fusebench::report {

namespace {

constexpr double kLargestError_m = 0.05;

/// Stray bits of a mesh would make the rest small.
void look_at_most(page::PageScene& scene) {
  constexpr double kStray = 0.02;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (const page::SceneMesh& mesh : scene.meshes) {
      for (const Vector3d& vertex : mesh.mesh.vertices) places.push_back(vertex[axis]);
    }
    if (places.empty()) return;
    std::ranges::sort(places);
    scene.low[axis] = mesh_error::percentile(places, kStray);
    scene.high[axis] = mesh_error::percentile(places, 1 - kStray);
  }
}

/// Of the poses that the model is of, in the frame of their first.
page::ScenePath path_of(const run_charts::RunSeries& run, std::size_t most) {
  const std::vector<run_charts::ComparedPose>& poses = run.final_poses.empty() ? run.poses : run.final_poses;
  page::ScenePath path{run.label, run.colour, {}};
  const std::size_t step = poses.size() / std::max<std::size_t>(most, 1) + 1;
  for (std::size_t i = 0; i < poses.size(); i += step) {
    path.poses.push_back({run.time_s(poses[i].timestamp_ns),
                          poses.front().T_truth_camera.inverse() * poses[i].T_truth_camera});
  }
  return path;
}

void move(PreciseMesh& mesh, const SE3& T_new_old) {
  for (Vector3d& vertex : mesh.vertices) vertex = T_new_old * vertex;
  const Matrix3d turn = T_new_old.rotation.toRotationMatrix();
  for (Eigen::Vector3f& normal : mesh.normals) normal = (turn * normal.cast<double>()).cast<float>();
}

/// Of "#0067a8".
Rgb rgb_of(std::string_view colour) {
  Rgb rgb{};
  for (std::size_t channel = 0; channel < rgb.size(); ++channel) {
    const char* const digits = colour.data() + 1 + 2 * channel;
    std::from_chars(digits, digits + 2, rgb[channel], 16);
  }
  return rgb;
}

/// path: in the frame of its first camera.
ColorImage picture_of_model(PreciseMesh mesh, const page::ScenePath& path, const SE3& T_first_world) {
  const SE3 T_world_first = T_first_world.inverse();
  std::vector<SE3> poses;
  for (const page::TimedPose& pose : path.poses) poses.push_back(T_world_first * pose.T_scene_camera);
  return model_picture(mesh_error::with_discs(std::move(mesh)), poses,
                       rgb_of(page::figure_colour(path.colour)));
}

}  // namespace

page::PageScene model_scene(std::span<const run_charts::RunSeries> runs, const SceneDetail& detail,
                            const PictureTaker& take_picture, std::vector<std::string>& warnings) {
  page::PageScene scene;
  scene.largest_error_m = kLargestError_m;
  scene.up = {0, -1, 0};  // of the first camera, whose y points down and whose z points ahead
  scene.ahead = {0, 0, 1};
  for (const run_charts::RunSeries& run : runs) {
    const auto file = run.run->folder / "mesh.ply";
    if (std::error_code ignored; !std::filesystem::exists(file, ignored)) continue;
    const auto checked = run_files::check_file(run.run->folder, run.run->record, "mesh.ply");
    auto mesh = checked ? mesh::read_ply(file) : tl::unexpected(checked.error());
    if (!mesh) warnings.push_back(mesh.error().message);
    if (!mesh || (mesh->triangles.empty() && mesh->radii_m.empty())) continue;
    page::SceneMesh shown{run.label, mesh_error::reduced(*mesh, detail.triangles), {}};
    move(shown.mesh, run.T_first_world);
    if (shown.mesh.colors.empty()) shown.mesh.colors.assign(shown.mesh.vertices.size(), Rgb{170, 170, 170});
    if (run.run->record.metrics.mesh.value && !shown.mesh.quality.empty()) {
      const std::vector<double> errors_m(shown.mesh.quality.begin(), shown.mesh.quality.end());
      shown.error_colors = mesh_error::error_colors(errors_m, kLargestError_m);
    }
    scene.paths.push_back(path_of(run, detail.poses));
    if (!scene.paths.back().poses.empty()) {
      const ColorImage picture = picture_of_model(*std::move(mesh), scene.paths.back(), run.T_first_world);
      shown.picture_uri = page::png_source(narrowed(picture, detail.picture_width_px));
      if (take_picture) take_picture(run, picture);
    }
    scene.meshes.push_back(std::move(shown));
  }
  look_at_most(scene);
  return scene;
}

}  // namespace fusebench::report
