#include "eval/page/drawn_data.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/io/text_table.hpp"
#include "eval/text/markup_text.hpp"

namespace fusebench::page {

namespace {

/// Six digits say what a chart can show, and halve the file.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return io::parse_number(fmt::format("{:.6g}", value)).value_or(value);
}

std::string_view style_name(SeriesStyle style) {
  switch (style) {
    case SeriesStyle::dots:
      return "dots";
    case SeriesStyle::bars:
      return "bars";
    case SeriesStyle::boxes:
      return "boxes";
    case SeriesStyle::backdrop:
      return "backdrop";
    case SeriesStyle::segments:
      return "segments";
    case SeriesStyle::band:
      return "band";
    case SeriesStyle::line:
      break;
  }
  return "line";
}

Json json_of(const std::optional<Vector2d>& range) {
  return range ? Json{number(range->x()), number(range->y())} : Json(nullptr);
}

Json json_of(const Vector3d& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

std::string bytes_text(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  return text::base64({bytes, size});
}

std::string colors_text(const std::vector<Rgb>& colors) {
  return bytes_text(colors.data(), colors.size() * sizeof(Rgb));
}

/// Of surfels: three signed bytes a normal, and radii as shares of the largest. Nothing of other meshes.
Json discs_of(const PreciseMesh& mesh) {
  if (mesh.radii_m.empty()) return nullptr;
  const float largest_m = std::ranges::max(mesh.radii_m);
  std::vector<std::int8_t> normals;
  std::vector<std::uint8_t> radii;
  for (std::size_t i = 0; i < mesh.radii_m.size(); ++i) {
    for (const float part : mesh.normals[i])
      normals.push_back(static_cast<std::int8_t>(std::lround(127 * std::clamp(part, -1.0F, 1.0F))));
    radii.push_back(static_cast<std::uint8_t>(std::lround(255 * mesh.radii_m[i] / largest_m)));
  }
  return {{"normals", bytes_text(normals.data(), normals.size())},
          {"radii", bytes_text(radii.data(), radii.size())},
          {"largest_radius_m", number(static_cast<double>(largest_m))}};
}

Json json_of(const SceneMesh& scene) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : scene.mesh.vertices) box.extend(vertex);
  if (box.isEmpty()) box.extend(Vector3d::Zero());
  constexpr double kSteps = 65'535;
  std::vector<std::uint16_t> positions;
  for (const Vector3d& vertex : scene.mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = std::max(box.sizes()[axis], 1e-9);
      positions.push_back(
          static_cast<std::uint16_t>(std::lround(kSteps * (vertex[axis] - box.min()[axis]) / extent)));
    }
  }
  return {{"label", scene.label},
          {"low", json_of(Vector3d(box.min()))},
          {"size", json_of(Vector3d(box.sizes()))},
          {"positions", bytes_text(positions.data(), positions.size() * sizeof(std::uint16_t))},
          {"triangles", bytes_text(scene.mesh.triangles.data(),
                                   scene.mesh.triangles.size() * sizeof(scene.mesh.triangles[0]))},
          {"discs", discs_of(scene.mesh)},
          {"colors", colors_text(scene.mesh.colors)},
          {"errors", colors_text(scene.error_colors)}};
}

/// Eight numbers a pose: time, position, quaternion (x, y, z, w).
Json json_of(const ScenePath& path) {
  Json numbers = Json::array();
  for (const TimedPose& pose : path.poses) {
    const Vector3d& p = pose.T_scene_camera.translation;
    const Quaterniond& q = pose.T_scene_camera.rotation;
    for (const double value : {pose.time_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()})
      numbers.push_back(io::parse_number(fmt::format("{:.4f}", value)).value_or(value));
  }
  return {{"label", path.label}, {"colour", path.colour}, {"poses", std::move(numbers)}};
}

}  // namespace

Json json_of(const Chart& chart, std::size_t part) {
  Json series = Json::array();
  for (std::size_t place = 0; place < chart.series.size(); ++place) {
    const ChartSeries& s = chart.series[place];
    Json points = Json::array();
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      points.push_back({number(s.points[i].x()), number(s.points[i].y())});
      if (!s.values.empty()) points.back().push_back(number(s.values[i]));
    }
    for (const ChartBox& box : s.boxes) {
      points.push_back({number(box.x), number(box.min), number(box.quartile), number(box.median),
                        number(box.upper_quartile), number(box.max)});
    }
    series.push_back({{"label", s.label},
                      {"style", style_name(s.style)},
                      {"colour", s.colour.value_or(place)},
                      {"right", s.right},
                      {"hidden", s.on_request},
                      {"points", points}});
  }
  return {{"x", chart.x_label},
          {"left", chart.left_label},
          {"right", chart.right_label},
          {"zero", chart.from_zero},
          {"equal", chart.equal_scale},
          {"log", chart.log_x},
          {"categories", chart.categories},
          {"names", chart.x_names},
          {"xRange", json_of(chart.x_range)},
          {"yRange", json_of(chart.y_range)},
          {"part", part},
          {"top", chart.value_colours ? Json(number(chart.value_colours->top)) : Json(nullptr)},
          {"series", series}};
}

Json json_of(const PageScene& scene, std::size_t part) {
  Json meshes = Json::array();
  for (const SceneMesh& mesh : scene.meshes) meshes.push_back(json_of(mesh));
  Json paths = Json::array();
  for (const ScenePath& path : scene.paths) paths.push_back(json_of(path));
  return {{"meshes", std::move(meshes)},
          {"paths", std::move(paths)},
          {"largest_error_m", scene.largest_error_m},
          {"low", json_of(scene.low)},
          {"high", json_of(scene.high)},
          {"up", scene.up},
          {"ahead", scene.ahead},
          {"part", part}};
}

}  // namespace fusebench::page
