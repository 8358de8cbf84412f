#include "datasets/inspection/measures/registration_fit.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace fusebench::inspection::measures {

namespace {

constexpr std::size_t kFrames = 24;
constexpr std::size_t kMaxEdges = 1500;  // of one frame
constexpr std::size_t kMinEdges = 1500;  // of all
constexpr int kMaxHole_px = 8;
constexpr float kJump = 0.1F;  // of the nearer depth
constexpr int kSurroundings_px = 16;
constexpr int kLevels = 3;               // of edge strength, each half the size of the one before
constexpr float kHalfStrength_grey = 6;  // gradient per pixel with half of the greatest strength
constexpr double kMinInside = 0.6;       // share of edges that a model must leave in the image
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
constexpr std::array kFromTheBest = {Step{1, 0}, Step{0.5, 0}, Step{0.25, 0}};

/// Strength of edges of colour across rows and along them, 0 to 1.
struct EdgeStrength {
  int width = 0;
  int height = 0;
  std::vector<float> upright;
  std::vector<float> level;

  [[nodiscard]] double at(const std::vector<float>& values, double x, double y) const {
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const float* row = values.data() + static_cast<std::ptrdiff_t>(y0) * width + x0;
    return (1 - fy) * ((1 - fx) * row[0] + fx * row[1]) + fy * ((1 - fx) * row[width] + fx * row[width + 1]);
  }
};

struct FrameEdges {
  std::vector<DepthEdge> edges;
  std::array<EdgeStrength, kLevels> strength;
};

EdgeStrength edge_strength(const GreyImage& grey) {
  EdgeStrength out{grey.width, grey.height, {}, {}};
  const auto size = static_cast<std::size_t>(grey.width) * static_cast<std::size_t>(grey.height);
  out.upright.assign(size, 0);
  out.level.assign(size, 0);
  const auto saturated = [](float difference) {
    const float gradient = std::abs(difference) / 2;
    return gradient / (gradient + kHalfStrength_grey);
  };
  for (int y = 1; y + 1 < grey.height; ++y) {
    for (int x = 1; x + 1 < grey.width; ++x) {
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(grey.width) + static_cast<std::size_t>(x);
      out.upright[at] = saturated(static_cast<float>(grey(x + 1, y)) - static_cast<float>(grey(x - 1, y)));
      out.level[at] = saturated(static_cast<float>(grey(x, y + 1)) - static_cast<float>(grey(x, y - 1)));
    }
  }
  return out;
}

EdgeStrength halved(const EdgeStrength& in) {
  EdgeStrength out{in.width / 2, in.height / 2, {}, {}};
  const auto halve = [&](const std::vector<float>& values) {
    std::vector<float> smaller;
    smaller.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y) {
      for (int x = 0; x < out.width; ++x) {
        const float* row = values.data() + static_cast<std::ptrdiff_t>(2 * y) * in.width + 2 * x;
        smaller.push_back((row[0] + row[1] + row[in.width] + row[in.width + 1]) / 4);
      }
    }
    return smaller;
  };
  out.upright = halve(in.upright);
  out.level = halve(in.level);
  return out;
}

/// Texture attracts edges wherever they are; what is left is whether there is an edge at this very place.
void subtract_local_mean(EdgeStrength& strength, int radius_px) {
  for (std::vector<float>* values : {&strength.upright, &strength.level}) {
    cv::Mat image(strength.height, strength.width, CV_32F, values->data());
    cv::Mat mean;
    cv::blur(image, mean, {2 * radius_px + 1, 2 * radius_px + 1});
    image -= mean;
  }
}

/// Adds the border between a measured pixel and the next one in its row or column, if there is one.
void add_edge(const DepthImage& depth_m, int x, int y, bool upright, std::vector<DepthEdge>& edges) {
  const float here_m = depth_m(x, y);
  for (int step = 1; step <= kMaxHole_px + 1; ++step) {
    const int to_x = upright ? x + step : x, to_y = upright ? y : y + step;
    if (to_x >= depth_m.width || to_y >= depth_m.height) return;
    const float there_m = depth_m(to_x, to_y);
    if (there_m <= 0) continue;
    const float nearer_m = std::min(here_m, there_m);
    if (std::abs(here_m - there_m) <= kJump * nearer_m) return;
    const float beside_px = here_m < there_m ? 0.5F : static_cast<float>(step) - 0.5F;
    edges.push_back({static_cast<float>(x) + (upright ? beside_px : 0),
                     static_cast<float>(y) + (upright ? 0 : beside_px), nearer_m, upright});
    return;
  }
}

FrameEdges frame_edges(const RgbdFrame& frame) {
  FrameEdges out;
  std::vector<DepthEdge> edges = depth_edges(frame.depth_m);
  const std::size_t count = std::min(edges.size(), kMaxEdges);
  for (std::size_t i = 0; i < count; ++i) out.edges.push_back(edges[i * edges.size() / count]);
  out.strength[0] = edge_strength(frame.grey);
  for (std::size_t level = 1; level < kLevels; ++level) out.strength[level] = halved(out.strength[level - 1]);
  for (std::size_t level = 0; level < kLevels; ++level)
    subtract_local_mean(out.strength[level], kSurroundings_px >> level);
  return out;
}

/// The five numbers of a model as movements in pixels that depend little on each other: at the border of the
/// image by the scale, and of edges that are near and that are far.
using Movements = std::array<double, 5>;

class EdgeScore {
 public:
  EdgeScore(std::vector<const FrameEdges*> frames, const PinholeCamera& camera)
      : frames_(std::move(frames)), camera_(camera) {
    std::vector<double> inverse_depths;
    for (const FrameEdges* frame : frames_)
      for (const DepthEdge& edge : frame->edges)
        inverse_depths.push_back(1 / static_cast<double>(edge.depth_m));
    std::ranges::sort(inverse_depths);
    far_ = inverse_depths[inverse_depths.size() / 10];
    near_ = std::max(inverse_depths[inverse_depths.size() * 9 / 10], far_ + 0.1);
  }

  [[nodiscard]] RegistrationModel model(const Movements& m) const {
    RegistrationModel out;
    out.scale = 1 + m[0] / (camera_.width_px / 2.0);
    const Eigen::Vector2d at_far(m[1], m[2]), at_near(m[3], m[4]);
    const Eigen::Vector2d slope = (at_near - at_far) / (near_ - far_);
    out.baseline_m = {slope.x() / camera_.fx_px, slope.y() / camera_.fy_px};
    out.shift_px = at_far - slope * far_;
    return out;
  }

  /// Mean strength under the moved edges at a level (of fewer edges at coarse ones); negative if too many
  /// leave the image.
  [[nodiscard]] double operator()(const RegistrationModel& model, std::size_t level) const {
    double sum = 0;
    std::size_t inside = 0, all = 0;
    const double shrink = std::ldexp(1.0, -static_cast<int>(level));
    for (const FrameEdges* frame : frames_) {
      const EdgeStrength& strength = frame->strength[level];
      for (std::size_t i = 0; i < frame->edges.size(); i += std::size_t{1} << (2 * level)) {
        const DepthEdge& edge = frame->edges[i];
        ++all;
        const Eigen::Vector2d at = ((model.move(edge, camera_).array() + 0.5) * shrink - 0.5).matrix();
        if (at.x() < 0 || at.y() < 0 || at.x() >= strength.width - 1 || at.y() >= strength.height - 1)
          continue;
        ++inside;
        sum += strength.at(edge.upright ? strength.upright : strength.level, at.x(), at.y());
      }
    }
    if (static_cast<double>(inside) < kMinInside * static_cast<double>(all)) return -1;
    return sum / static_cast<double>(inside);
  }

  /// rms distance in pixels between where two models move the edges.
  [[nodiscard]] double distance_px(const RegistrationModel& a, const RegistrationModel& b) const {
    double sum = 0, count = 0;
    for (const FrameEdges* frame : frames_) {
      for (const DepthEdge& edge : frame->edges) {
        sum += (a.move(edge, camera_) - b.move(edge, camera_)).squaredNorm();
        ++count;
      }
    }
    return std::sqrt(sum / std::max(1.0, count));
  }

 private:
  std::vector<const FrameEdges*> frames_;
  PinholeCamera camera_;
  double far_ = 0;   ///< 1 / m
  double near_ = 1;  ///< 1 / m
};

/// For each of a row of scales the best of a grid of shifts at the coarsest level; of these the best few.
std::vector<Movements> coarse_search(const EdgeScore& score, double half_width_px) {
  std::vector<std::pair<double, Movements>> by_scale;
  for (const double scale : kCoarseScales) {
    std::pair<double, Movements> best{-1, {}};
    for (int y = -kCoarseReach_px; y <= kCoarseReach_px; y += kCoarseStep_px) {
      for (int x = -kCoarseReach_px; x <= kCoarseReach_px; x += kCoarseStep_px) {
        const auto dx = static_cast<double>(x), dy = static_cast<double>(y);
        const Movements movements = {(scale - 1) * half_width_px, dx, dy, dx, dy};
        best = std::max(best, {score(score.model(movements), kLevels - 1), movements});
      }
    }
    by_scale.push_back(best);
  }
  std::ranges::sort(by_scale, std::ranges::greater{});
  std::vector<Movements> starts = {Movements{}};
  for (std::size_t i = 0; i < kStarts; ++i) starts.push_back(by_scale[i].second);
  return starts;
}

/// Steps along each movement alone and along both of one axis; the next size of steps when none improves.
Movements fine_search(const EdgeScore& score, Movements at, std::span<const Step> steps) {
  constexpr std::array<std::array<double, 5>, 7> kDirections = {{{1, 0, 0, 0, 0},
                                                                 {0, 1, 0, 1, 0},
                                                                 {0, 0, 1, 0, 1},
                                                                 {0, 1, 0, 0, 0},
                                                                 {0, 0, 1, 0, 0},
                                                                 {0, 0, 0, 1, 0},
                                                                 {0, 0, 0, 0, 1}}};
  for (const auto& [step, level] : steps) {
    double best = score(score.model(at), level);
    for (bool improved = true; improved;) {
      improved = false;
      for (const auto& direction : kDirections) {
        for (const double sign : {-step, step}) {
          Movements to = at;
          for (std::size_t i = 0; i < to.size(); ++i) to[i] += sign * direction[i];
          const double value = score(score.model(to), level);
          if (value <= best) continue;
          best = value;
          at = to;
          improved = true;
        }
      }
    }
  }
  return at;
}

Movements search(const EdgeScore& score, double half_width_px) {
  constexpr std::size_t kLevel = kFromEachStart.back().level;
  std::pair<double, Movements> best{-1, {}};
  for (const Movements& start : coarse_search(score, half_width_px)) {
    const Movements found = fine_search(score, start, kFromEachStart);
    const double value = score(score.model(found), kLevel);
    if (value > best.first) best = {value, found};
  }
  return fine_search(score, best.second, kFromTheBest);
}

std::vector<FrameEdges> load_edges(const recording::Recording& recording, const Workers& workers) {
  const std::size_t frames = recording.frames.size();
  const std::size_t count = std::min(frames, kFrames);
  return workers.map_chunks<FrameEdges>(count, 1, [&](std::size_t i, std::size_t) {
    const auto frame = recording.load_frame(i * frames / count);
    return frame ? frame_edges(*frame) : FrameEdges{};
  });
}

}  // namespace

std::vector<DepthEdge> depth_edges(const DepthImage& depth_m) {
  std::vector<DepthEdge> edges;
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      if (depth_m(x, y) <= 0) continue;
      add_edge(depth_m, x, y, true, edges);
      add_edge(depth_m, x, y, false, edges);
    }
  }
  return edges;
}

Eigen::Vector2d RegistrationModel::move(const DepthEdge& edge, const PinholeCamera& camera) const {
  const double x = camera.cx_px + scale * (edge.x_px - camera.cx_px) + shift_px.x() +
                   camera.fx_px * baseline_m.x() / edge.depth_m;
  const double y = camera.cy_px + scale * (edge.y_px - camera.cy_px) + shift_px.y() +
                   camera.fy_px * baseline_m.y() / edge.depth_m;
  return {x, y};
}

std::optional<RegistrationFit> fit_registration(const recording::Recording& recording,
                                                const Workers& workers) {
  const std::vector<FrameEdges> frames = load_edges(recording, workers);
  std::vector<const FrameEdges*> all;
  std::array<std::vector<const FrameEdges*>, 2> halves;
  RegistrationFit fit;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].edges.empty()) continue;
    fit.edges += frames[i].edges.size();
    halves[all.size() % 2].push_back(&frames[i]);
    all.push_back(&frames[i]);
  }
  if (fit.edges < kMinEdges || all.size() < 4) return std::nullopt;
  fit.frames = all.size();
  const PinholeCamera& camera = recording.rig.camera;
  const EdgeScore score(all, camera);
  const double half_width_px = camera.width_px / 2.0;
  const std::vector<Movements> found = workers.map_chunks<Movements>(3, 1, [&](std::size_t i, std::size_t) {
    const EdgeScore part(i == 0 ? all : halves[i - 1], camera);
    return search(part, half_width_px);
  });
  fit.model = score.model(found[0]);
  fit.strength_as_read = score({}, 0);
  fit.strength_moved = score(fit.model, 0);
  for (const FrameEdges* frame : all) {
    const EdgeScore alone({frame}, camera);
    if (alone(fit.model, 0) > alone({}, 0)) fit.better_share += 1 / static_cast<double>(all.size());
  }
  fit.moved_px = score.distance_px({}, fit.model);
  const EdgeScore first(halves[0], camera), second(halves[1], camera);
  fit.spread_px = score.distance_px(first.model(found[1]), second.model(found[2]));
  fit.as_read = {camera, SE3{}};
  if (recording.calibration && recording.calibration->depth) fit.as_read = *recording.calibration->depth;
  fit.fitted = fitted_depth_camera(fit.model, camera, fit.as_read);
  return fit;
}

calibration::DepthCamera fitted_depth_camera(const RegistrationModel& model, const PinholeCamera& color,
                                             const calibration::DepthCamera& as_read) {
  calibration::DepthCamera out = as_read;
  out.pinhole.fx_px /= model.scale;
  out.pinhole.fy_px /= model.scale;
  // A shift of the moved image is one of the centre by the same angle.
  out.pinhole.cx_px -= model.shift_px.x() / color.fx_px * out.pinhole.fx_px;
  out.pinhole.cy_px -= model.shift_px.y() / color.fy_px * out.pinhole.fy_px;
  out.T_color_depth.translation.x() = model.scale * out.T_color_depth.translation.x() + model.baseline_m.x();
  out.T_color_depth.translation.y() = model.scale * out.T_color_depth.translation.y() + model.baseline_m.y();
  return out;
}

}  // namespace fusebench::inspection::measures
