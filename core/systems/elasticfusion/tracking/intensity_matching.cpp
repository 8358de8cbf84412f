#include "core/systems/elasticfusion/tracking/intensity_matching.hpp"

#include <cmath>

namespace fusebench::systems::elasticfusion::tracking {

namespace {

constexpr std::size_t kPixelsAtOnce = 4096;
constexpr float kMostDepth_m = 6;
constexpr float kMostApart_m = 0.07F;

using Vector6f = Eigen::Matrix<float, 6, 1>;

struct Match {
  Vector6f direction;  ///< how the residual falls by a step
  float residual;      ///< frame less model
};

class IntensityMatcher {
 public:
  IntensityMatcher(const PinholeCamera& camera, const ViewLevel& view, const SE3& T_view_camera)
      : fx_(static_cast<float>(camera.fx_px)),
        fy_(static_cast<float>(camera.fy_px)),
        cx_(static_cast<float>(view.camera.cx_px)),
        cy_(static_cast<float>(view.camera.cy_px)),
        view_(view),
        R_(T_view_camera.rotation_matrix().cast<float>()),
        t_(T_view_camera.translation.cast<float>()) {}

  [[nodiscard]] bool match(const TellingPixel& pixel, Match& match) const {
    const Eigen::Vector3f seen = R_ * pixel.point + t_;
    if (!(seen.z() > 0)) return false;
    const float u = fx_ * seen.x() / seen.z() + cx_ + 0.5F, v = fy_ * seen.y() / seen.z() + cy_ + 0.5F;
    if (!(u >= 0) || !(v >= 0) || !(u < static_cast<float>(view_.camera.width_px)) ||
        !(v < static_cast<float>(view_.camera.height_px)))
      return false;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const std::size_t at = view_.depth_m.index(x, y);
    const float depth_m = view_.depth_m.data[at];
    if (!(depth_m > 0) || std::abs(depth_m - seen.z()) > kMostApart_m) return false;
    const Eigen::Vector3f point((static_cast<float>(x) - cx_) / fx_ * depth_m,
                                (static_cast<float>(y) - cy_) / fy_ * depth_m, depth_m);
    const Eigen::Vector3f here = R_.transpose() * (point - t_);
    if (!(here.z() > 0)) return false;
    const float gx = pixel.gradient.x() * fx_ / here.z(), gy = pixel.gradient.y() * fy_ / here.z();
    const Eigen::Vector3f slope = R_ * Eigen::Vector3f(gx, gy, -(gx * here.x() + gy * here.y()) / here.z());
    match.direction << point.cross(slope), slope;
    match.residual = pixel.intensity - view_.intensity.data[at];
    return true;
  }

 private:
  float fx_, fy_, cx_, cy_;
  const ViewLevel& view_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
};

PoseSums sums_of(const std::vector<Match>& matches, double sigma) {
  PoseSums sums;
  for (const Match& match : matches) {
    const auto residual = static_cast<double>(match.residual);
    const double divisor = sigma + std::abs(residual);
    const double weight = divisor > 0 ? 1 / divisor : 1.0;
    const Vector6d along = weight * match.direction.cast<double>();
    sums.information.selfadjointView<Eigen::Lower>().rankUpdate(along);
    sums.descent += weight * residual * along;
    sums.cost += residual * residual;
    sums.pixels += 1;
  }
  const Matrix6d lower = sums.information;
  sums.information = lower.selfadjointView<Eigen::Lower>();
  return sums;
}

}  // namespace

std::vector<TellingPixel> telling_pixels(const LiveLevel& live, double min_gradient) {
  std::vector<TellingPixel> pixels;
  const auto least = static_cast<float>(min_gradient * min_gradient);
  for (int y = 0; y < live.depth_m.height; ++y) {
    for (int x = 0; x < live.depth_m.width; ++x) {
      const std::size_t at = live.depth_m.index(x, y);
      const Eigen::Vector2f gradient(live.dx.data[at], live.dy.data[at]);
      const float depth_m = live.depth_m.data[at];
      if (!(depth_m > 0) || !(depth_m < kMostDepth_m) || !(gradient.squaredNorm() >= least)) continue;
      pixels.push_back({live.intensity.data[at], gradient,
                        live.camera.back_project(x, y, static_cast<double>(depth_m)).cast<float>()});
    }
  }
  return pixels;
}

PoseSums match_intensities(const std::vector<TellingPixel>& pixels, const PinholeCamera& camera,
                           const ViewLevel& view, const SE3& T_view_camera, config::PeerDefects defects,
                           const Workers& workers) {
  const IntensityMatcher matcher(camera, view, T_view_camera);
  const auto parts = workers.map_chunks<std::vector<Match>>(pixels.size(), kPixelsAtOnce,
                                                            [&](std::size_t begin, std::size_t end) {
                                                              std::vector<Match> matches;
                                                              matches.reserve(end - begin);
                                                              Match match;
                                                              for (std::size_t i = begin; i < end; ++i) {
                                                                if (matcher.match(pixels[i], match))
                                                                  matches.push_back(match);
                                                              }
                                                              return matches;
                                                            });
  double squares = 0, count = 0;
  for (const auto& matches : parts) {
    for (const Match& match : matches) squares += static_cast<double>(match.residual * match.residual);
    count += static_cast<double>(matches.size());
  }
  if (count == 0) return {};
  const double sigma = std::sqrt(defects == config::PeerDefects::as_published ? count : squares / count);
  const auto sums = workers.map_chunks<PoseSums>(
      parts.size(), 1, [&](std::size_t part, std::size_t /*end*/) { return sums_of(parts[part], sigma); });
  PoseSums total;
  for (const PoseSums& part : sums) total += part;
  return total;
}

}  // namespace fusebench::systems::elasticfusion::tracking
