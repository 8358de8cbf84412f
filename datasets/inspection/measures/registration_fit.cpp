#include "datasets/inspection/measures/registration_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "datasets/inspection/measures/clustered_scatter.hpp"
#include "datasets/inspection/measures/depth_edges.hpp"

namespace fusebench::inspection::measures {

namespace {

constexpr std::size_t kFrames = 48;
constexpr std::size_t kMinEdges = 1500;  // of all
constexpr std::size_t kPeriods = 16;     // of frames whose errors may be common
constexpr int kCellsAcross = 4;          // of the image, in which errors may be common to all frames
constexpr std::size_t kCells = kCellsAcross * kCellsAcross;
constexpr double kMinInside = 0.6;  // share of edges that a model must leave in the image
constexpr int kCoarseReach_px = 36;
constexpr int kCoarseStep_px = 4;
constexpr std::array kCoarseScales = {0.80, 0.84, 0.88, 0.92, 0.96, 1.0, 1.04, 1.08, 1.13, 1.18, 1.24};
constexpr std::size_t kStarts = 5;
/// Of a search, and the level of edge strength that they are taken at.
struct Step {
  double px;
  std::size_t level;
};
constexpr std::array kFromEachStart = {Step{4, 2}, Step{2, 1}};

/// Scale (as the movement at the left and the right border of the image, px), shift (px), baseline times
/// focal length (px m), delay (intervals of frames), growth across and along rows (px).
constexpr int kNumbers = 8;
constexpr int kOfCamera = 5;
using Numbers = Eigen::Matrix<double, kNumbers, 1>;
using Square = Eigen::Matrix<double, kNumbers, kNumbers>;

class EdgeScore {
 public:
  EdgeScore(std::vector<const FrameEdges*> frames, const PinholeCamera& camera)
      : frames_(std::move(frames)), camera_(camera), half_width_px_(camera.width_px / 2.0) {}

  [[nodiscard]] RegistrationModel model(const Numbers& p) const {
    return {1 + p[0] / half_width_px_, {p[1], p[2]}, {p[3] / camera_.fx_px, p[4] / camera_.fy_px}};
  }

  [[nodiscard]] Numbers prior_sigma() const {
    constexpr double kScale = 0.2, kShift_px = 30, kBaseline_m = 0.03, kDelay = 2, kGrowth_px = 2;
    const double baseline_px_m = kBaseline_m * camera_.fx_px;
    return (Numbers() << kScale * half_width_px_, kShift_px, kShift_px, baseline_px_m, baseline_px_m, kDelay,
            kGrowth_px, kGrowth_px)
        .finished();
  }

  /// Mean strength under the moved edges at a level (of fewer edges at coarse ones); negative if too many
  /// leave the image.
  [[nodiscard]] double operator()(const Numbers& p, std::size_t level) const {
    double sum = 0;
    std::size_t inside = 0, all = 0;
    for (const FrameEdges* frame : frames_) {
      for (std::size_t i = 0; i < frame->edges.size(); i += std::size_t{1} << (2 * level)) {
        ++all;
        const auto sample = sample_of(*frame, frame->edges[i], p, level);
        if (!sample) continue;
        ++inside;
        sum += sample->value;
      }
    }
    if (static_cast<double>(inside) < kMinInside * static_cast<double>(all)) return -1;
    return sum / static_cast<double>(inside);
  }

  /// Derivatives of the sum of strengths at the finest level across the edges.
  [[nodiscard]] Grid<Numbers> gradients(const Numbers& p, const Workers& workers) const {
    return sums<Numbers>(workers, Numbers::Zero(), [&](const FrameEdges& frame, const DepthEdge& edge) {
      return gradient_of(frame, edge, p);
    });
  }

  /// Number of edges, and strength at the finest level at `to` less that at `from`.
  [[nodiscard]] Grid<Eigen::Vector2d> gains(const Numbers& from, const Numbers& to,
                                            const Workers& workers) const {
    return sums<Eigen::Vector2d>(
        workers, Eigen::Vector2d::Zero(), [&](const FrameEdges& frame, const DepthEdge& edge) {
          const auto before = sample_of(frame, edge, from, 0), after = sample_of(frame, edge, to, 0);
          return Eigen::Vector2d(1, (after ? after->value : 0) - (before ? before->value : 0));
        });
  }

  /// A step of about two pixels of each number, for numeric derivatives.
  [[nodiscard]] Numbers steps() const {
    constexpr double kStep_px = 2;
    double sum = 0;
    for (const FrameEdges* frame : frames_) sum += frame->motion_px.squaredNorm();
    const double motion_px = std::sqrt(sum / static_cast<double>(frames_.size()));
    Numbers steps = Numbers::Constant(kStep_px);
    steps[kOfCamera] = kStep_px / std::max(kStep_px, motion_px);
    return steps;
  }

  [[nodiscard]] double mean_depth_m() const {
    double sum = 0, count = 0;
    for (const FrameEdges* frame : frames_) {
      for (const DepthEdge& edge : frame->edges) sum += edge.depth_m;
      count += static_cast<double>(frame->edges.size());
    }
    return sum / count;
  }

  /// rms over the edges of how far the camera's numbers move them, and of its standard deviation.
  [[nodiscard]] std::pair<double, double> movement_px(const Numbers& p, const Square& covariance) const {
    double moved = 0, variance = 0, count = 0;
    for (const FrameEdges* frame : frames_) {
      for (const DepthEdge& edge : frame->edges) {
        for (int axis = 0; axis < 2; ++axis) {
          Numbers by = by_numbers(*frame, edge, axis);
          by.tail<kNumbers - kOfCamera>().setZero();
          moved += std::pow(by.dot(p), 2);
          variance += by.dot(covariance * by);
        }
        ++count;
      }
    }
    return {std::sqrt(moved / count), std::sqrt(variance / count)};
  }

 private:
  template <typename T, typename OfEdge>
  [[nodiscard]] Grid<T> sums(const Workers& workers, const T& zero, const OfEdge& of_edge) const {
    const std::size_t length = (frames_.size() + kPeriods - 1) / kPeriods;
    return workers.map_chunks<std::vector<T>>(frames_.size(), length,
                                              [&](std::size_t begin, std::size_t end) {
                                                std::vector<T> cells(kCells, zero);
                                                for (std::size_t k = begin; k < end; ++k) {
                                                  for (const DepthEdge& edge : frames_[k]->edges)
                                                    cells[cell_of(edge)] += of_edge(*frames_[k], edge);
                                                }
                                                return cells;
                                              });
  }

  [[nodiscard]] std::size_t cell_of(const DepthEdge& edge) const {
    const auto at = [](float place_px, int size_px) {
      return std::clamp(static_cast<int>(place_px) * kCellsAcross / size_px, 0, kCellsAcross - 1);
    };
    return static_cast<std::size_t>(at(edge.y_px, camera_.height_px) * kCellsAcross +
                                    at(edge.x_px, camera_.width_px));
  }

  /// Of the place of an edge along an axis. The model is linear in its numbers.
  [[nodiscard]] Numbers by_numbers(const FrameEdges& frame, const DepthEdge& edge, int axis) const {
    const double from_centre_px = axis == 0 ? edge.x_px - camera_.cx_px : edge.y_px - camera_.cy_px;
    const bool across = edge.upright == (axis == 0);
    Numbers by = Numbers::Zero();
    by[0] = from_centre_px / half_width_px_;
    by[1 + axis] = 1;
    by[3 + axis] = 1 / static_cast<double>(edge.depth_m);
    by[5] = frame.motion_px[axis];
    by[6 + axis] = !across ? 0 : edge.ends_nearer ? 1 : -1;
    return by;
  }

  [[nodiscard]] Numbers gradient_of(const FrameEdges& frame, const DepthEdge& edge, const Numbers& p) const {
    const auto sample = sample_of(frame, edge, p, 0);
    if (!sample) return Numbers::Zero();
    const int axis = edge.upright ? 0 : 1;
    return sample->by_pixel[axis] * by_numbers(frame, edge, axis);
  }

  [[nodiscard]] std::optional<StrengthSample> sample_of(const FrameEdges& frame, const DepthEdge& edge,
                                                        const Numbers& p, std::size_t level) const {
    const EdgeStrength& strength = frame.strength[level];
    const double shrink = std::ldexp(1.0, -static_cast<int>(level));
    const double x = shrink * (edge.x_px + by_numbers(frame, edge, 0).dot(p) + 0.5) - 0.5;
    const double y = shrink * (edge.y_px + by_numbers(frame, edge, 1).dot(p) + 0.5) - 0.5;
    if (!(x >= 0 && y >= 0 && x < strength.width - 1 && y < strength.height - 1)) return std::nullopt;
    return strength.at(edge.upright ? strength.upright : strength.level, x, y);
  }

  std::vector<const FrameEdges*> frames_;
  PinholeCamera camera_;
  double half_width_px_;
};

/// For each of a row of scales the best of a grid of shifts at the coarsest level; of these the best few.
std::vector<Numbers> coarse_search(const EdgeScore& score, double half_width_px, const Workers& workers) {
  using Scored = std::pair<double, Numbers>;
  std::vector<Scored> by_scale =
      workers.map_chunks<Scored>(kCoarseScales.size(), 1, [&](std::size_t i, std::size_t) {
        Scored best{-1, Numbers::Zero()};
        for (int y = -kCoarseReach_px; y <= kCoarseReach_px; y += kCoarseStep_px) {
          for (int x = -kCoarseReach_px; x <= kCoarseReach_px; x += kCoarseStep_px) {
            Numbers p = Numbers::Zero();
            p.head<3>() << (kCoarseScales[i] - 1) * half_width_px, x, y;
            const double value = score(p, kStrengthLevels - 1);
            if (value > best.first) best = {value, p};
          }
        }
        return best;
      });
  std::ranges::stable_sort(by_scale, std::ranges::greater{}, &Scored::first);
  std::vector<Numbers> starts = {Numbers::Zero()};
  for (std::size_t i = 0; i < kStarts; ++i) starts.push_back(by_scale[i].second);
  return starts;
}

/// Steps along scale, shift and baseline alone; the next size of steps when none improves.
Numbers fine_search(const EdgeScore& score, Numbers at, std::span<const Step> steps) {
  for (const auto& [step, level] : steps) {
    double best = score(at, level);
    for (bool improved = true; improved;) {
      improved = false;
      for (int i = 0; i < 2 * kOfCamera; ++i) {
        Numbers to = at;
        to[i / 2] += i % 2 == 0 ? step : -step;
        const double value = score(to, level);
        if (value <= best) continue;
        best = value;
        at = to;
        improved = true;
      }
    }
  }
  return at;
}

Numbers search(const EdgeScore& score, double half_width_px, const Workers& workers) {
  constexpr std::size_t kLevel = kFromEachStart.back().level;
  const std::vector<Numbers> starts = coarse_search(score, half_width_px, workers);
  const auto found = workers.map_chunks<Numbers>(starts.size(), 1, [&](std::size_t i, std::size_t) {
    return fine_search(score, starts[i], kFromEachStart);
  });
  return *std::ranges::max_element(found, {}, [&](const Numbers& p) { return score(p, kLevel); });
}

/// The score as a quadratic, in units of information: gradient and curvature over a common factor by which
/// their scatter becomes that of a likelihood.
struct Quadratic {
  Numbers gradient;
  Square information;
  Square scatter;
};

Quadratic quadratic_at(const EdgeScore& score, const Numbers& p, const Workers& workers) {
  const Grid<Numbers> gradients = score.gradients(p, workers);
  Quadratic q{sum_of(gradients), Square::Zero(), clustered_covariance(gradients)};
  const Numbers steps = score.steps();
  for (int i = 0; i < kNumbers; ++i) {
    Numbers before = p, after = p;
    before[i] -= steps[i];
    after[i] += steps[i];
    q.information.col(i) =
        (sum_of(score.gradients(before, workers)) - sum_of(score.gradients(after, workers))) / (2 * steps[i]);
  }
  q.information = (0.5 * (q.information + q.information.transpose())).eval();
  double factor = 0, observed = 0;
  for (int i = 0; i < kNumbers; ++i) {
    if (!(q.information(i, i) > 0)) continue;
    factor += q.scatter(i, i) / q.information(i, i);
    ++observed;
  }
  factor = std::max(1e-12, factor / std::max(1.0, observed));
  q.gradient /= factor;
  q.information /= factor;
  q.scatter /= factor * factor;
  return q;
}

/// The inverse of a symmetric matrix with the magnitudes of its eigenvalues: a step against a wrong curvature
/// goes uphill all the same.
Square positive_inverse(const Square& matrix) {
  const Eigen::SelfAdjointEigenSolver<Square> eigen(matrix);
  const double least = 1e-9 * eigen.eigenvalues().cwiseAbs().maxCoeff();
  const Numbers inverse = eigen.eigenvalues().cwiseAbs().cwiseMax(least).cwiseInverse();
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

struct Estimate {
  Numbers numbers;
  Square covariance;
};

Estimate refine(const EdgeScore& score, Numbers p, const Workers& workers) {
  constexpr int kMostSteps = 15;
  constexpr double kLongest_px = 2;
  constexpr double kConverged_px = 0.1;
  const Numbers prior_information = score.prior_sigma().cwiseAbs2().cwiseInverse();
  const Square prior = prior_information.asDiagonal();
  for (int i = 0;; ++i) {
    const Quadratic q = quadratic_at(score, p, workers);
    const Square inverse = positive_inverse(q.information + prior);
    Numbers step = inverse * (q.gradient - prior_information.cwiseProduct(p));
    const double longest = step.cwiseAbs().maxCoeff();
    if (i == kMostSteps || !(longest > kConverged_px)) return {p, inverse * (q.scatter + prior) * inverse};
    step *= std::min(1.0, kLongest_px / longest);
    p += step;
  }
}

/// The camera's numbers set to zero: depth as it was read, with its delay and growth.
Numbers unmoved(Numbers p) {
  p.head<kOfCamera>().setZero();
  return p;
}

/// Gain of strength by the move over its standard deviation.
double gain_sigmas(const EdgeScore& score, const Numbers& moved, const Workers& workers) {
  const Grid<Eigen::Vector2d> gains = score.gains(unmoved(moved), moved, workers);
  const Eigen::Vector2d all = sum_of(gains);
  Grid<Eigen::Matrix<double, 1, 1>> deviations(gains.size());
  for (std::size_t period = 0; period < gains.size(); ++period) {
    for (const Eigen::Vector2d& cell : gains[period])
      deviations[period].emplace_back(cell[1] - cell[0] * all[1] / all[0]);
  }
  return all[1] / std::sqrt(std::max(1e-12, clustered_covariance(deviations)(0, 0)));
}

/// With what the scatter of frames does not show, as a displacement at the border, everywhere, and at the
/// mean depth of the edges.
DepthCameraSigma sigma_of(const Estimate& estimate, double mean_depth_m, const RegistrationFit& fit,
                          const PinholeCamera& color) {
  constexpr double kCommon_px = RegistrationFit::kCommonSigma_px;
  Numbers common = Numbers::Constant(kCommon_px);
  common.segment<2>(3) *= mean_depth_m;
  const Numbers sigma = (estimate.covariance.diagonal() + common.cwiseAbs2()).cwiseSqrt();
  const double focal_length_px = fit.fitted.pinhole.fx_px;
  DepthCameraSigma result;
  result.focal_length_px = focal_length_px / fit.model.scale * sigma[0] / (color.width_px / 2.0);
  result.centre_px = sigma.segment<2>(1) * focal_length_px / color.fx_px;
  result.place_m = sigma.segment<2>(3) / color.fx_px;
  return result;
}

}  // namespace

std::optional<RegistrationFit> fit_registration(const recording::Recording& recording,
                                                const Workers& workers) {
  const std::vector<FrameEdges> frames = load_edges(recording, kFrames, workers);
  std::vector<const FrameEdges*> all;
  RegistrationFit fit;
  for (const FrameEdges& frame : frames) {
    if (frame.edges.empty()) continue;
    fit.edges += frame.edges.size();
    all.push_back(&frame);
  }
  if (fit.edges < kMinEdges || all.size() < 4) return std::nullopt;
  fit.frames = all.size();
  const PinholeCamera& camera = recording.rig.camera;
  const EdgeScore score(all, camera);
  const Estimate estimate = refine(score, search(score, camera.width_px / 2.0, workers), workers);
  const Numbers& moved = estimate.numbers;
  fit.model = score.model(moved);
  fit.delay_frames = moved[kOfCamera];
  fit.strength_as_read = score(unmoved(moved), 0);
  fit.strength_moved = score(moved, 0);
  fit.gain_sigmas = gain_sigmas(score, moved, workers);
  std::tie(fit.moved_px, fit.sigma_px) = score.movement_px(moved, estimate.covariance);
  fit.as_read = depth_camera_as_read(recording);
  fit.fitted = fitted_depth_camera(fit.model, camera, fit.as_read);
  fit.fitted_sigma = sigma_of(estimate, score.mean_depth_m(), fit, camera);
  return fit;
}

calibration::DepthCamera depth_camera_as_read(const recording::Recording& recording) {
  if (recording.calibration && recording.calibration->depth) return *recording.calibration->depth;
  return {recording.rig.camera, SE3{}};
}

}  // namespace fusebench::inspection::measures
