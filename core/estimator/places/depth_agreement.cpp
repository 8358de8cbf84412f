#include "core/estimator/places/depth_agreement.hpp"

#include <cmath>
#include <cstddef>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/estimator/places/small_images.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::places {

namespace {

/// A pixel of one place and its position in the small images of the other.
struct SeenPixel {
  int x = 0, y = 0;   ///< in the first place
  int u = 0, v = 0;   ///< in the second place
  double here_m = 0;  ///< its depth in the second camera
  double there_m = 0;
};

/// Calls the callback for each pixel of `from` that projects to a pixel with depth of `to`. Returns the
/// number of pixels of `from` with depth.
template <class Callback>
std::size_t for_each_seen(const SmallImages& from, const SmallImages& to, const SE3& T_to_from,
                          const PinholeCamera& camera, const Callback& callback) {
  std::size_t measured = 0;
  for (int y = 0; y < from.depth_m.height; ++y) {
    for (int x = 0; x < from.depth_m.width; ++x) {
      if (!(from.depth_m(x, y) > 0)) continue;
      ++measured;
      const Vector3d point = T_to_from * point_at(from.depth_m, x, y, camera);
      const auto there = pixel_of(point, camera, to.depth_m);
      if (!there || !(to.depth_m(there->x, there->y) > 0)) continue;
      callback(SeenPixel{x, y, there->x, there->y, point.z(),
                         static_cast<double>(to.depth_m(there->x, there->y))});
    }
  }
  return measured;
}

bool on_surface(const SeenPixel& seen, const config::DepthConfig& depth, const config::LoopsConfig& loops) {
  constexpr double kAllowance_m = 0.01;  // error of interpolation and calibration
  const double sigma_m = preprocessing::depth_sigma_m(seen.here_m, depth);
  return std::abs(seen.here_m - seen.there_m) <= loops.depth_sigmas * sigma_m + kAllowance_m;
}

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Running sums of pairs of numbers.
struct PairSums {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  void add(double first, double second) {
    n += 1;
    a += first;
    b += second;
    aa += first * first;
    bb += second * second;
    ab += first * second;
  }
  [[nodiscard]] double variance_a() const { return aa / n - (a / n) * (a / n); }
  [[nodiscard]] double variance_b() const { return bb / n - (b / n) * (b / n); }
  [[nodiscard]] double covariance() const { return ab / n - (a / n) * (b / n); }
};

}  // namespace

DepthAgreement depth_agreement(const SmallImages& from, const SmallImages& to, const SE3& T_to_from,
                               const PinholeCamera& camera, const config::DepthConfig& depth,
                               const config::LoopsConfig& loops) {
  std::size_t seen = 0, consistent = 0, violating = 0;
  const std::size_t measured = for_each_seen(from, to, T_to_from, camera, [&](const SeenPixel& pixel) {
    ++seen;
    if (on_surface(pixel, depth, loops)) {
      ++consistent;
    } else if (pixel.here_m < pixel.there_m) {
      ++violating;
    }
  });
  return {share(seen, measured), share(consistent, measured), share(violating, seen)};
}

std::optional<double> grey_correlation(const SmallImages& from, const SmallImages& to, const SE3& T_to_from,
                                       const PinholeCamera& camera, const config::DepthConfig& depth,
                                       const config::LoopsConfig& loops, double min_contrast_grey) {
  PairSums sums;
  for_each_seen(from, to, T_to_from, camera, [&](const SeenPixel& seen) {
    if (on_surface(seen, depth, loops)) sums.add(from.grey(seen.x, seen.y), to.grey(seen.u, seen.v));
  });
  if (sums.n < 1) return std::nullopt;
  const double least = min_contrast_grey * min_contrast_grey;
  if (sums.variance_a() < least || sums.variance_b() < least) return std::nullopt;
  return sums.covariance() / std::sqrt(sums.variance_a() * sums.variance_b());
}

}  // namespace fusebench::places
