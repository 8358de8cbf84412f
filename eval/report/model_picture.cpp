#include "eval/report/model_picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "core/base/error.hpp"
#include "eval/report/model_view.hpp"
#include "eval/report/narrowed_image.hpp"

namespace fusebench::report {

namespace {

constexpr int kWidth_px = 800;
constexpr double kFlattest = 0.5;  // height / width
constexpr double kHighest = 0.9;
constexpr double kStrayShare = 0.01;  // share of the vertices that is not in view, at each side
constexpr double kElevation_deg = 25;
constexpr double kAzimuth_deg = 15;  // to the side of the direction in which the camera mostly looked

/// Some of the vertices: those of a framing need not be all.
std::vector<Vector3d> some_vertices(const PreciseMesh& mesh) {
  constexpr std::size_t kCount = 20'000;
  const std::size_t step = mesh.vertices.size() / kCount + 1;
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) points.push_back(mesh.vertices[i]);
  return points;
}

Eigen::AlignedBox3d middle_of(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (const Vector3d& point : points) places.push_back(point[axis]);
    std::ranges::sort(places);
    const auto stray = static_cast<std::size_t>(kStrayShare * static_cast<double>(places.size()));
    box.min()[axis] = places[stray];
    box.max()[axis] = places[places.size() - 1 - stray];
  }
  return box;
}

/// Of the view, that looks at the middle of the box. Up is against the mean of the cameras' y axes, which
/// point down.
SE3 T_mesh_view(const Eigen::AlignedBox3d& box, std::span<const SE3> poses) {
  Vector3d down = Vector3d::Zero(), ahead = Vector3d::Zero();
  for (const SE3& pose : poses) {
    down += pose.rotation * Vector3d::UnitY();
    ahead += pose.rotation * Vector3d::UnitZ();
  }
  down.normalize();
  Vector3d level = ahead - ahead.dot(down) * down;
  if (level.norm() < 0.1 * static_cast<double>(poses.size())) {  // it looked around, or up and down
    const Vector3d first = poses.front().rotation * Vector3d::UnitZ();
    level = first - first.dot(down) * down;
  }
  const Vector3d right = down.cross(level).normalized();
  Matrix3d R_mesh_level;
  R_mesh_level << right, down, right.cross(down);
  const Matrix3d R = R_mesh_level * so3_exp({0, radians(kAzimuth_deg), 0}).toRotationMatrix() *
                     so3_exp({radians(-kElevation_deg), 0, 0}).toRotationMatrix();
  constexpr double kDistance = 2;  // in diagonals of the box
  return {Quaterniond(R), box.center() - kDistance * box.diagonal().norm() * R.col(2)};
}

/// A path that is far from the model belongs to a camera that was lost, and would make the model small.
std::vector<Vector3d> near_places(std::span<const SE3> poses, const Eigen::AlignedBox3d& box) {
  const Vector3d margin = Vector3d::Constant(box.diagonal().norm());
  const Eigen::AlignedBox3d around(Vector3d(box.min() - margin), Vector3d(box.max() + margin));
  std::vector<Vector3d> places;
  for (const SE3& pose : poses) {
    if (around.contains(pose.translation)) places.push_back(pose.translation);
  }
  return places;
}

/// A line with a white edge, so that it is seen on any colour.
void draw_path(const std::vector<Vector3d>& places, const PinholeCamera& camera, const SE3& T_view_mesh,
               const Rgb& colour, ColorImage& image) {
  constexpr int kFractionBits = 4;
  std::vector<cv::Point> pixels;
  for (const Vector3d& place : places) {
    const Vector2d at = (1 << kFractionBits) * camera.project(T_view_mesh * place);
    pixels.emplace_back(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
  }
  if (pixels.empty()) return;
  cv::Mat view(image.height, image.width, CV_8UC3, image.data.data());
  const cv::Scalar line(colour[0], colour[1], colour[2]);
  for (const auto& [stroke, width_px, radius_px] :
       {std::tuple(cv::Scalar::all(255), 5, 8), std::tuple(line, 3, 6)}) {
    cv::polylines(view, pixels, false, stroke, width_px, cv::LINE_AA, kFractionBits);
    cv::circle(view, pixels.front(), radius_px << kFractionBits, stroke, cv::FILLED, cv::LINE_AA,
               kFractionBits);
  }
}

}  // namespace

ColorImage model_picture(const PreciseMesh& mesh, std::span<const SE3> poses, const Rgb& path) {
  check(!mesh.vertices.empty() && !poses.empty(), "a picture is of a mesh and a path");
  const std::vector<Vector3d> points = some_vertices(mesh);
  const Eigen::AlignedBox3d box = middle_of(points);
  const SE3 T = T_mesh_view(box, poses);
  const std::vector<Vector3d> places = near_places(poses, box);
  Eigen::AlignedBox2d seen = seen_box(points, T, kStrayShare);
  if (!places.empty()) seen.extend(seen_box(places, T, 0));
  const double shape = std::clamp(seen.sizes().y() / std::max(seen.sizes().x(), 1e-6), kFlattest, kHighest);
  const int height_px = static_cast<int>(std::lround(kWidth_px * shape));
  const ColorImage large =
      model_view(mesh.cast<float>(), camera_around(seen, 2 * kWidth_px, 2 * height_px), T);
  ColorImage image = narrowed(large, kWidth_px);
  draw_path(places, camera_around(seen, kWidth_px, height_px), T.inverse(), path, image);
  return image;
}

}  // namespace fusebench::report
