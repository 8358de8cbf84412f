#include "core/baselines/elasticfusion/deformation/fern_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/baselines/elasticfusion/deformation/view_registration.hpp"
#include "core/estimator/places/ferns/cell_means.hpp"
#include "core/estimator/places/ferns/color_fern_code.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

namespace {

constexpr double kKeptDissimilarity = 0.3095;
constexpr double kLeastSimilarity = 0.3;
constexpr double kMostError_m = 3e-4;
constexpr double kMostColorDifference = 115;  // sum over the three channels

PinholeCamera small_camera(const PinholeCamera& camera) {
  const double across = static_cast<double>(ferns::kWidth) / camera.width_px;
  const double down = static_cast<double>(ferns::kHeight) / camera.height_px;
  return {ferns::kWidth,       ferns::kHeight,        across * camera.fx_px,
          down * camera.fy_px, across * camera.cx_px, down * camera.cy_px};
}

/// Mean difference of colour where both views show the same surface.
double color_difference(const surfels::SurfelView& query, const surfels::SurfelView& place,
                        const SE3& T_place_camera) {
  double sum = 0, count = 0;
  for (std::size_t pixel = 0; pixel < query.surfel.data.size(); ++pixel) {
    const Eigen::Vector3f point = query.point.at(pixel);
    if (!(point.z() > 0)) continue;
    const Vector3d there = T_place_camera * point.cast<double>();
    if (!(there.z() > 0)) continue;
    const Vector2d at = place.camera.project(there);
    const auto x = static_cast<int>(std::floor(at.x() + 0.5)), y = static_cast<int>(std::floor(at.y() + 0.5));
    if (!place.surfel.contains(x, y) || !(place.point.z(x, y) > 0)) continue;
    const Rgb &a = query.color.data[pixel], &b = place.color(x, y);
    for (std::size_t channel = 0; channel < 3; ++channel) sum += std::abs(a[channel] - b[channel]);
    count += 1;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

}  // namespace

FernPlace fern_place(const surfels::LiveFrame& live, const surfels::SurfelView& view, std::int32_t time) {
  FernPlace place;
  place.code = ferns::color_fern_code(live.color, live.smooth_m);
  place.time = time;
  surfels::SurfelView& small = place.view;
  small.camera = small_camera(view.camera);
  small.T_world_camera = view.T_world_camera;
  small.point.resize(ferns::kWidth, ferns::kHeight);
  small.normal.resize(ferns::kWidth, ferns::kHeight);
  small.color = ColorImage(ferns::kWidth, ferns::kHeight);
  small.surfel = Image<std::int32_t>(ferns::kWidth, ferns::kHeight, surfels::kNoSurfel);
  for (int y = 0; y < ferns::kHeight; ++y) {
    for (int x = 0; x < ferns::kWidth; ++x) {
      const int u = x * view.camera.width_px / ferns::kWidth, v = y * view.camera.height_px / ferns::kHeight;
      const std::size_t from = view.surfel.index(u, v), to = small.surfel.index(x, y);
      const bool model = view.surfel.data[from] != surfels::kNoSurfel;
      small.surfel.data[to] = view.surfel.data[from];
      small.point.put(
          to,
          model
              ? view.point.at(from)
              : view.camera.back_project(u, v, static_cast<double>(live.smooth_m.data[from])).cast<float>());
      small.normal.put(to, model ? view.normal.at(from) : live.normal.at(from));
      small.color.data[to] = model ? view.color.data[from] : live.color.data[from];
    }
  }
  return place;
}

bool FernPlaces::offer(const FernPlace& place) {
  const bool is_known = std::ranges::any_of(places_, [&](const FernPlace& known) {
    return ferns::dissimilarity(known.code, place.code) <= kKeptDissimilarity;
  });
  if (!is_known) places_.push_back(place);
  return !is_known;
}

std::optional<FoundPlace> FernPlaces::find(const FernPlace& query, std::int32_t min_age,
                                           double min_matches) const {
  std::optional<std::size_t> best;
  double best_dissimilarity = 1 - kLeastSimilarity;
  for (std::size_t i = 0; i < places_.size() && query.time - places_[i].time > min_age; ++i) {
    const double dissimilarity = ferns::dissimilarity(places_[i].code, query.code);
    if (dissimilarity < best_dissimilarity) {
      best = i;
      best_dissimilarity = dissimilarity;
    }
  }
  if (!best) return std::nullopt;
  const surfels::SurfelView& view = places_[*best].view;
  const tracking::TrackedMotion motion = register_view(query.view, view, config_, workers_);
  if (motion.was_dropped || motion.matches <= min_matches || motion.error_m >= kMostError_m)
    return std::nullopt;
  if (color_difference(query.view, view, motion.T_view_camera) >= kMostColorDifference) return std::nullopt;
  return FoundPlace{*best, motion.T_view_camera};
}

void FernPlaces::deform(const DeformationGraph& graph) {
  for (FernPlace& place : places_)
    place.view.T_world_camera = graph.moved(place.view.T_world_camera, place.time);
}

}  // namespace fusebench::baselines::elasticfusion::deformation
