#include "core/estimator/measurement/patch_translation.hpp"

#include <Eigen/LU>

#include "core/base/simd/image_lanes.hpp"

namespace fusebench::measurement {

namespace {

constexpr int kMaxSteps = 20;
constexpr double kConvergedPx = 0.01;

/// Eight translated pixels and their validity.
struct MovedPixels {
  MovedPixels(const patches::WarpedLanes& warped, const Eigen::Vector2f& by_px, const GreyImage& image)
      : x(warped.x + by_px.x()), y(warped.y + by_px.y()) {
    inside = (x >= 1.0F) & (y >= 1.0F) & (x <= static_cast<float>(image.width - 2)) &
             (y <= static_cast<float>(image.height - 2));
  }
  simd::Float8 x;
  simd::Float8 y;
  simd::Int8 inside;
};

/// Gauss-Newton step on one level (pixels of the level); zero if the patch has no texture.
Vector2d step_px(const PlacedPatch& patch, const Eigen::Vector2f& at_px) {
  simd::Float8 xx{}, xy{}, yy{}, xr{}, yr{};
  for (std::size_t i = 0; i < patch.warped.size(); ++i) {
    const MovedPixels moved(patch.warped[i], at_px, patch.image);
    const simd::Int8 used = patch.warped[i].visible & moved.inside;
    if (!simd::any(used)) continue;
    const simd::IntensityLanes seen = simd::sample_bicubic(
        patch.image, used ? moved.x : simd::all_lanes(1.0F), used ? moved.y : simd::all_lanes(1.0F));
    const simd::Float8 dx = used ? seen.dx : simd::Float8{};
    const simd::Float8 dy = used ? seen.dy : simd::Float8{};
    const simd::Float8 residual = seen.value - patch.pixels[i].intensity;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
    xr += dx * residual;
    yr += dy * residual;
  }
  Eigen::Matrix2d normal;
  normal << simd::sum_of_lanes(xx), simd::sum_of_lanes(xy), simd::sum_of_lanes(xy), simd::sum_of_lanes(yy);
  const double trace = normal.trace();
  // An edge constrains the translation in one direction only: the smaller eigenvalue is then a rounding error
  // of the larger.
  if (!(normal.determinant() > 1e-6 * trace * trace)) return Vector2d::Zero();
  return -normal.inverse() * Vector2d(simd::sum_of_lanes(xr), simd::sum_of_lanes(yr));
}

}  // namespace

Vector2d own_translation_px(std::span<const PlacedPatch> levels) {
  Vector2d translation_px = Vector2d::Zero();
  for (std::size_t level = levels.size(); level-- > 0;) {
    const auto scale = static_cast<double>(1 << level);
    for (int i = 0; i < kMaxSteps; ++i) {
      const Vector2d step = step_px(levels[level], (translation_px / scale).cast<float>());
      translation_px += scale * step;
      if (step.norm() < kConvergedPx) break;
    }
  }
  return translation_px;
}

void translate(std::span<patches::WarpedLanes> warped, const Vector2d& by_px, const GreyImage& image) {
  for (patches::WarpedLanes& w : warped) {
    const MovedPixels moved(w, by_px.cast<float>(), image);
    w.x = moved.x;
    w.y = moved.y;
    w.in_image &= moved.inside;
    w.visible &= moved.inside;
  }
}

}  // namespace fusebench::measurement
