#include "datasets/inspection/misreadings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/signed_permutations.hpp"

namespace fusebench::inspection {

namespace {

// Residuals below these are not significant: 1 mm at 1 m, half a grey level.
constexpr double kDepthFloor = 0.001;
constexpr double kIntensityFloor_grey = 0.5;
constexpr double kLostRatio = 4;  // of a pair that a reading warps out of view

const Eigen::DiagonalMatrix<double, 3> kFlip(1, -1, 1);

SE3 inverted(const SE3& pose) { return pose.inverse(); }

SE3 rotation_inverted(const SE3& pose) { return {pose.rotation.conjugate(), pose.translation}; }

/// The file has w x y z, and x y z w was read.
SE3 scalar_first(const SE3& pose) {
  const Quaterniond& q = pose.rotation;
  return {Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

/// R B, t. A B that mirrors leaves no rotation; then the world is mirrored as well: W R B, W t.
SE3 of_camera_axes(const SE3& pose, const Matrix3d& axes) {
  const Matrix3d rotation = pose.rotation_matrix() * axes;
  if (axes.determinant() > 0) return {Quaterniond(rotation).normalized(), pose.translation};
  return {Quaterniond(Matrix3d(kFlip * rotation)).normalized(), kFlip * pose.translation};
}

SE3 of_position_axes(const SE3& pose, const Matrix3d& axes) {
  return {pose.rotation, axes * pose.translation};
}

using PoseChange = std::function<SE3(const SE3&)>;

std::function<void(measures::Reading&)> changing_poses(PoseChange change) {
  return [change = std::move(change)](measures::Reading& reading) {
    reading.pose = [before = reading.pose, change](const SE3& pose) {
      return change(before ? before(pose) : pose);
    };
  };
}

void add_misreadings_of_images(std::vector<Misreading>& all) {
  struct Mirror {
    bool x, y;
    const char* name;
    const char* remedy;
  };
  constexpr std::array<Mirror, 3> kMirrors = {
      Mirror{true, false, "mirrored", "mirror the colour images (left to right)"},
      Mirror{true, true, "upside down", "rotate the colour images by 180 degrees"},
      Mirror{false, true, "mirrored top to bottom", "mirror the colour images (top to bottom)"}};
  for (const Mirror& mirror : kMirrors) {
    all.push_back({"color-mirrored", fmt::format("colour {}", mirror.name),
                   fmt::format("colour is {} against depth: turning it back", mirror.name), mirror.remedy,
                   [mirror](measures::Reading& reading) {
                     reading.color_mirrored_x ^= mirror.x;
                     reading.color_mirrored_y ^= mirror.y;
                   },
                   false});
  }
  all.push_back({"depth-along-ray", "depth along the ray",
                 "depth is the distance to the camera's centre along the ray of the pixel, not its z "
                 "component: dividing it by sqrt(1 + x^2 + y^2)",
                 "write z = d / sqrt(1 + x^2 + y^2) with x = (u - cx) / fx, y = (v - cy) / fy",
                 [](measures::Reading& reading) { reading.depth_along_ray = true; }, false});
}

void add_misreadings_of_poses(std::vector<Misreading>& all) {
  all.push_back({"truth-inverted", "inverted poses",
                 "the poses map from the world to the camera: inverting them",
                 "invert the poses: groundtruth.txt holds camera positions in the world",
                 changing_poses(&inverted), false});
  all.push_back({"truth-rotation-inverted", "inverted rotations",
                 "the rotations map from the world to the camera: inverting them",
                 "conjugate the quaternions (negate qx, qy, qz)", changing_poses(&rotation_inverted), false});
  all.push_back({"truth-quaternion-order", "quaternions as w x y z",
                 "the quaternions are in the order w x y z: reading them so",
                 "groundtruth.txt holds qx qy qz qw", changing_poses(&scalar_first), false});
}

std::string hint_of_reflection(bool negative_focal_length) {
  if (negative_focal_length)
    return "images are stored top-down: use a positive fy_px and reflect the poses (F T F, F = diag(1, -1, "
           "1))";
  return "reflect the poses: F T F with F = diag(1, -1, 1), that is (tx, -ty, tz) and (-qx, qy, -qz, qw); "
         "--format icl does it for ICL-NUIM";
}

std::string matrix_rows(const Matrix3d& m) {
  return fmt::format("[{} {} {}; {} {} {}; {} {} {}]", m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2),
                     m(2, 0), m(2, 1), m(2, 2));
}

/// What may be wrong in place of the poses: images of both cameras that were turned or mirrored together.
std::string alternative_of_images(const Matrix3d& axes) {
  if (axes.isApprox(Matrix3d(Vector3d(-1, 1, 1).asDiagonal())))
    return ", or mirror the images of colour and depth (left to right)";
  if (axes.isApprox(Matrix3d(Vector3d(-1, -1, 1).asDiagonal())))
    return ", or rotate the images of colour and depth by 180 degrees";
  return "";
}

/// The poses are of a camera whose axes are a signed permutation of (right, down, forward).
void add_camera_axes(std::vector<Misreading>& all, bool negative_focal_length) {
  constexpr std::array<std::string_view, 3> kDirections{"right", "down", "forward"};
  constexpr std::array<std::string_view, 3> kOpposite{"left", "up", "back"};
  for (const Matrix3d& axes : measures::signed_permutations()) {
    // Minus the identity is a reflection of the positions.
    if (axes.isIdentity() || (-axes).isIdentity()) continue;
    const auto apply = changing_poses([axes](const SE3& pose) { return of_camera_axes(pose, axes); });
    if (axes.isApprox(Matrix3d(kFlip))) {
      all.push_back({"truth-not-reflected", "poses reflected about the x-z plane (or fy negated)",
                     "the poses are those of a y-up camera, or fy has the wrong sign: reflecting them",
                     hint_of_reflection(negative_focal_length), apply, false});
      continue;
    }
    const std::string directions = measures::permutation_text(axes, kDirections, kOpposite);
    const bool mirrors = axes.determinant() < 0;
    all.push_back(
        {"truth-camera-axes", fmt::format("camera axes {}", directions),
         fmt::format("the poses are those of a camera whose (x, y, z) axes point {}, not (right, down, "
                     "forward): changing them",
                     directions),
         fmt::format("{} B = {}{}",
                     mirrors ? "replace R by W R B and t by W t, with W = diag(1, -1, 1) and"
                             : "multiply each rotation from the right by",
                     matrix_rows(axes), alternative_of_images(axes)),
         apply});
  }
}

/// The positions have other axes than the world of the rotations.
void add_position_axes(std::vector<Misreading>& all) {
  for (const Matrix3d& axes : measures::signed_permutations()) {
    if (axes.isIdentity()) continue;
    const std::string text = measures::permutation_text(axes, {"tx", "ty", "tz"});
    all.push_back(
        {"truth-position-axes", fmt::format("positions {}", text),
         fmt::format("the positions have other axes than the rotations{}: reading (tx, ty, tz) as {}",
                     axes.determinant() < 0 ? ", left-handed ones" : "", text),
         fmt::format("replace the positions (tx, ty, tz) of the ground truth by {}", text),
         changing_poses([axes](const SE3& pose) { return of_position_axes(pose, axes); })});
  }
}

using ReadingOf = std::function<measures::Reading(double)>;

/// The best of a row of values, then a golden-section search between its neighbours.
FittedParameter fit(const WarpTest& test, const measures::Reading& base, const std::vector<double>& values,
                    const ReadingOf& reading_of) {
  const auto residuals = test.residuals(base);
  const auto factor = [&](double value) { return test.compare(residuals, reading_of(value)).factor; };
  std::size_t best = 0;
  double best_factor = factor(values[0]);
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double f = factor(values[i]);
    if (f < best_factor) {
      best = i;
      best_factor = f;
    }
  }
  double low = values[best == 0 ? 0 : best - 1], high = values[std::min(best + 1, values.size() - 1)];
  constexpr double kGolden = 0.6180339887498949;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double left_factor = factor(left), right_factor = factor(right);
  for (int i = 0; i < 8; ++i) {
    if (left_factor < right_factor) {
      high = right;
      right = left;
      right_factor = left_factor;
      left = high - kGolden * (high - low);
      left_factor = factor(left);
    } else {
      low = left;
      left = right;
      left_factor = right_factor;
      right = low + kGolden * (high - low);
      right_factor = factor(right);
    }
  }
  const double value = std::min(left_factor, right_factor) < best_factor
                           ? (left_factor < right_factor ? left : right)
                           : values[best];
  return {value, test.compare(residuals, reading_of(value))};
}

/// Mean of the logarithms of the ratios of depth and intensity residuals. A reading of colour alone leaves
/// those of depth as they are, and is decided by intensity.
double log_ratio(const measures::WarpResidual& other, const measures::WarpResidual& base) {
  const double intensity =
      std::log((other.intensity_grey + kIntensityFloor_grey) / (base.intensity_grey + kIntensityFloor_grey));
  if (other.depth_share == base.depth_share) return intensity;
  return 0.5 * intensity +
         0.5 * std::log((other.depth_share + kDepthFloor) / (base.depth_share + kDepthFloor));
}

/// Small ones in steps of 20 ms, and up to 1 s in steps of 40 ms.
std::vector<double> row_of_shifts() {
  std::vector<double> shifts_s;
  for (int i = -50; i <= 50; ++i) {
    if (std::abs(i) <= 12 || i % 2 == 0) shifts_s.push_back(0.02 * i);
  }
  return shifts_s;
}

std::vector<double> geometric_row(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low * std::pow(high / low, i / (count - 1.0)));
  return values;
}

FittedParameter fit_scale(const WarpTest& test, const measures::Reading& base, const std::vector<double>& row,
                          double measures::Reading::*scale) {
  return fit(test, base, row, [&](double value) {
    measures::Reading reading = base;
    reading.*scale *= value;
    return reading;
  });
}

FittedParameter fit_shift(const WarpTest& test, const measures::Reading& base,
                          std::int64_t measures::Reading::*shift_ns) {
  return fit(test, base, row_of_shifts(), [&](double value) {
    measures::Reading reading = base;
    reading.*shift_ns += std::llround(1e9 * value);
    return reading;
  });
}

}  // namespace

WarpTest::WarpTest(const recording::Recording& recording, std::vector<measures::WarpPair> pairs,
                   const Workers& workers)
    : recording_(recording), pairs_(std::move(pairs)), gap_ns_(truth_gap_ns(recording)), workers_(workers) {}

std::vector<std::optional<measures::WarpResidual>> WarpTest::residuals(
    const measures::Reading& reading) const {
  return workers_.map_chunks<std::optional<measures::WarpResidual>>(
      pairs_.size(), 1, [&](std::size_t i, std::size_t) {
        return measures::warp(pairs_[i], recording_.rig.camera, recording_.ground_truth, gap_ns_, reading);
      });
}

Comparison WarpTest::compare_every(std::size_t step,
                                   const std::vector<std::optional<measures::WarpResidual>>& base,
                                   const measures::Reading& reading) const {
  const std::size_t compared = (pairs_.size() + step - 1) / step;
  const auto ratios =
      workers_.map_chunks<std::optional<double>>(compared, 1, [&](std::size_t k, std::size_t) {
        const std::size_t i = k * step;
        return base[i] ? ratio_of(pairs_[i], *base[i], reading) : std::nullopt;
      });
  double sum = 0, wins = 0, count = 0;
  for (const std::optional<double>& ratio : ratios) {
    if (!ratio) continue;  // no ground truth: counts for neither reading
    ++count;
    sum += *ratio;
    if (*ratio < 0) ++wins;
  }
  if (count < 0.5 * static_cast<double>(compared) || count == 0) return {kLostRatio, 0};
  return {std::exp(sum / count), wins / count};
}

std::optional<double> WarpTest::ratio_of(const measures::WarpPair& pair, const measures::WarpResidual& base,
                                         const measures::Reading& reading) const {
  const auto other = measures::warp(pair, recording_.rig.camera, recording_.ground_truth, gap_ns_, reading);
  if (!other) return std::nullopt;
  // A reading must not improve by warping most points out of view.
  const bool lost = other->overlap < 0.5 * base.overlap || other->points < 50;
  return lost ? std::log(kLostRatio) : log_ratio(*other, base);
}

Comparison WarpTest::compare(const std::vector<std::optional<measures::WarpResidual>>& base,
                             const measures::Reading& reading) const {
  return compare_every(1, base, reading);
}

Comparison WarpTest::screen(const std::vector<std::optional<measures::WarpResidual>>& base,
                            const measures::Reading& reading) const {
  const Comparison some = compare_every(3, base, reading);
  return some.factor < 1 ? compare(base, reading) : some;
}

std::vector<Misreading> misreadings(const PinholeCamera& camera) {
  std::vector<Misreading> all;
  add_misreadings_of_images(all);
  add_misreadings_of_poses(all);
  add_camera_axes(all, camera.fy_px < 0);
  add_position_axes(all);
  return all;
}

FittedParameter fit_depth_scale(const WarpTest& test, const measures::Reading& base) {
  return fit_scale(test, base, geometric_row(0.125, 8, 37), &measures::Reading::depth_scale);
}

FittedParameter fit_focal_scale(const WarpTest& test, const measures::Reading& base) {
  return fit_scale(test, base, geometric_row(0.7, 1.0 / 0.7, 17), &measures::Reading::focal_scale);
}

FittedParameter fit_image_scale(const WarpTest& test, const measures::Reading& base) {
  return fit_scale(test, base, geometric_row(0.2, 5, 31), &measures::Reading::image_scale);
}

FittedParameter fit_truth_shift(const WarpTest& test, const measures::Reading& base) {
  return fit_shift(test, base, &measures::Reading::truth_shift_ns);
}

FittedParameter fit_depth_shift(const WarpTest& test, const measures::Reading& base) {
  return fit_shift(test, base, &measures::Reading::depth_shift_ns);
}

}  // namespace fusebench::inspection
