#include "core/baselines/elasticfusion/tracking/intensity_matching.hpp"

#include <cmath>

#include "core/base/simd/lane_points.hpp"
#include "core/config/groups/systems_config.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

namespace {

using simd::Float8;
using simd::Int8;

constexpr std::size_t kPixelsAtOnce = 4096;
constexpr float kMostDepth_m = 6;
constexpr float kMostDepthApart_m = 0.07F;

/// Eight pixels with their matches in the model.
struct Match {
  Int8 valid;
  Float8 column, row;  ///< projection into the view
  Float8 depth_m;      ///< of the model
  Float8 residual;     ///< frame minus model
};

class IntensityMatcher {
 public:
  IntensityMatcher(const TellingPixels& pixels, const ViewLevel& view, const SE3& T_view_camera,
                   config::PeerDefects defects)
      : pixels_(pixels),
        view_(view),
        at_whole_pixels_(defects == config::PeerDefects::as_published),
        fx_(static_cast<float>(pixels.camera.fx_px)),
        fy_(static_cast<float>(pixels.camera.fy_px)),
        cx_(static_cast<float>(view.camera.cx_px)),
        cy_(static_cast<float>(view.camera.cy_px)),
        R_(T_view_camera.rotation_matrix().cast<float>()),
        t_(T_view_camera.translation.cast<float>()),
        R_camera_view_(R_.transpose()),
        t_camera_view_(-(R_camera_view_ * t_)) {}

  [[nodiscard]] Match match(std::size_t first) const {
    const simd::Points point = {simd::load(&pixels_.x[first]), simd::load(&pixels_.y[first]),
                                simd::load(&pixels_.z[first])};
    const simd::Points seen = simd::moved(R_, t_, point);
    const auto width = static_cast<float>(view_.camera.width_px);
    const auto height = static_cast<float>(view_.camera.height_px);
    const Float8 u = fx_ * seen.x / seen.z + cx_, v = fy_ * seen.y / seen.z + cy_;
    Match match{};
    match.valid = (point.z > 0.0F) & (seen.z > 0.0F) & (u >= -0.5F) & (v >= -0.5F) & (u < width - 0.5F) &
                  (v < height - 0.5F);
    const Int8 column = simd::to_int(simd::clamp(u + 0.5F, 0.0F, width - 1));
    const Int8 row = simd::to_int(simd::clamp(v + 0.5F, 0.0F, height - 1));
    const Int8 at = row * view_.camera.width_px + column;
    match.depth_m = simd::gather(view_.depth_m.data.data(), at);
    match.valid &= is_near(match.depth_m, seen.z);
    const Float8 measured = simd::load(&pixels_.intensity[first]);
    if (at_whole_pixels_) {
      match.column = simd::to_float(column);
      match.row = simd::to_float(row);
      match.residual = measured - simd::gather(view_.intensity.data.data(), at);
    } else {
      match.column = u;
      match.row = v;
      match.residual = measured - between_pixels(u, v, seen.z, match.valid);
    }
    return match;
  }

  /// Adds the squared residuals of matched pixels and their number.
  void count(std::size_t first, Float8& squares, Float8& number) const {
    const Match found = match(first);
    const Float8 none{};
    squares += found.valid ? found.residual * found.residual : none;
    number += found.valid ? simd::all_lanes(1.0F) : none;
  }

  void add(std::size_t first, float sigma, PoseSumLanes& sums) const {
    Match found = match(first);
    if (!simd::any(found.valid)) return;
    const simd::Points point = {(found.column - cx_) / fx_ * found.depth_m,
                                (found.row - cy_) / fy_ * found.depth_m, found.depth_m};
    const simd::Points here = simd::moved(R_camera_view_, t_camera_view_, point);
    found.valid &= here.z > 0.0F;
    const Float8 gx = simd::load(&pixels_.dx[first]) * fx_ / here.z;
    const Float8 gy = simd::load(&pixels_.dy[first]) * fy_ / here.z;
    const simd::Points slope = simd::rotated(R_, {gx, gy, -(gx * here.x + gy * here.y) / here.z});
    const simd::Points arm = simd::cross(point, slope);
    const Float8 divisor = sigma + simd::abs(found.residual);
    const Float8 weight = divisor > 0.0F ? 1.0F / (divisor * divisor) : simd::all_lanes(1.0F);
    sums.add({arm.x, arm.y, arm.z, slope.x, slope.y, slope.z}, weight * found.residual, weight,
             weight * found.residual * found.residual, found.valid);
  }

 private:
  static Int8 is_near(Float8 model_m, Float8 seen_m) {
    return (model_m > 0.0F) & (simd::abs(model_m - seen_m) <= kMostDepthApart_m);
  }

  /// The model's intensity by bilinear interpolation; invalid if one of the four pixels shows another surface
  /// or none.
  [[nodiscard]] Float8 between_pixels(Float8 u, Float8 v, Float8 seen_m, Int8& valid) const {
    const PinholeCamera& camera = view_.camera;
    const Int8 left = simd::to_int(simd::clamp(u, 0.0F, static_cast<float>(camera.width_px - 2)));
    const Int8 top = simd::to_int(simd::clamp(v, 0.0F, static_cast<float>(camera.height_px - 2)));
    const Float8 right_share = u - simd::to_float(left), lower_share = v - simd::to_float(top);
    valid &= (right_share >= 0.0F) & (right_share <= 1.0F) & (lower_share >= 0.0F) & (lower_share <= 1.0F);
    const auto pixel = [&](Int8 at) {
      valid &= is_near(simd::gather(view_.depth_m.data.data(), at), seen_m);
      return simd::gather(view_.intensity.data.data(), at);
    };
    const auto row = [&](Int8 at) {
      const Float8 value = pixel(at);
      return simd::multiply_add(right_share, pixel(at + 1) - value, value);
    };
    const Int8 at = top * camera.width_px + left;
    const Float8 upper = row(at);
    return simd::multiply_add(lower_share, row(at + camera.width_px) - upper, upper);
  }

  const TellingPixels& pixels_;
  const ViewLevel& view_;
  bool at_whole_pixels_;
  float fx_, fy_, cx_, cy_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
  Eigen::Matrix3f R_camera_view_;
  Eigen::Vector3f t_camera_view_;
};

struct ResidualCount {
  double squares = 0;
  double number = 0;
};

}  // namespace

TellingPixels telling_pixels(const LiveLevel& live, double min_gradient) {
  TellingPixels pixels;
  pixels.camera = live.camera;
  const auto add = [&](const Eigen::Vector3f& point, float dx, float dy, float intensity) {
    pixels.x.push_back(point.x());
    pixels.y.push_back(point.y());
    pixels.z.push_back(point.z());
    pixels.dx.push_back(dx);
    pixels.dy.push_back(dy);
    pixels.intensity.push_back(intensity);
  };
  const auto least = static_cast<float>(min_gradient * min_gradient);
  for (int y = 0; y < live.depth_m.height; ++y) {
    for (int x = 0; x < live.depth_m.width; ++x) {
      const std::size_t at = live.depth_m.index(x, y);
      const float dx = live.gradient.dx.data[at], dy = live.gradient.dy.data[at],
                  depth_m = live.depth_m.data[at];
      if (!(depth_m > 0) || !(depth_m < kMostDepth_m) || !(dx * dx + dy * dy >= least)) continue;
      add(live.camera.back_project(x, y, static_cast<double>(depth_m)).cast<float>(), dx, dy,
          live.intensity.data[at]);
    }
  }
  while (pixels.z.size() % simd::kLanes != 0) add(Eigen::Vector3f::Zero(), 0, 0, 0);
  return pixels;
}

PoseSums match_intensities(const TellingPixels& pixels, const ViewLevel& view, const SE3& T_view_camera,
                           config::PeerDefects defects, const Workers& workers) {
  const IntensityMatcher matcher(pixels, view, T_view_camera, defects);
  ResidualCount residuals;
  for (const ResidualCount& part : workers.map_chunks<ResidualCount>(
           pixels.z.size(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
             Float8 squares{}, number{};
             for (std::size_t i = begin; i < end; i += simd::kLanes) matcher.count(i, squares, number);
             return ResidualCount{simd::sum_of_lanes(squares), simd::sum_of_lanes(number)};
           })) {
    residuals.squares += part.squares;
    residuals.number += part.number;
  }
  if (residuals.number == 0) return {};
  const bool slip = defects == config::PeerDefects::as_published;
  const auto sigma =
      static_cast<float>(std::sqrt(slip ? residuals.number : residuals.squares / residuals.number));
  PoseSums total;
  for (const PoseSums& part :
       workers.map_chunks<PoseSums>(pixels.z.size(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
         PoseSumLanes sums;
         for (std::size_t i = begin; i < end; i += simd::kLanes) matcher.add(i, sigma, sums);
         return sums.total();
       }))
    total += part;
  return total;
}

}  // namespace fusebench::baselines::elasticfusion::tracking
