// Depth against colour: where depth jumps, something ends, and its image mostly changes there, too.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "datasets/inspection/checks.hpp"

namespace fusebench {

namespace {

constexpr std::size_t kFrames = 16;
constexpr int kReach = 3;      // pixels to each side of a jump, past the holes that sensors have there
constexpr double kJump = 0.1;  // of the depth
constexpr int kMaxShift_px = 24;
constexpr int kStep_px = 2;
constexpr int kShifts = 2 * kMaxShift_px / kStep_px + 1;
constexpr std::size_t kMaxEdges = 3000;  // of one frame
constexpr std::size_t kMinEdges = 2000;  // of all
constexpr int kTolerance_px = 6;         // sensors fatten what is near by a few pixels

using Scores = std::array<double, static_cast<std::size_t>(kShifts) * kShifts>;

struct FrameScores {
  Scores sums{};
  std::size_t edges = 0;
};

bool jumps(float a_m, float b_m) {
  return a_m > 0 && b_m > 0 && std::abs(a_m - b_m) > kJump * static_cast<double>(std::min(a_m, b_m));
}

struct Pixel {
  int x;
  int y;
};

std::vector<Pixel> depth_edges(const DepthImage& depth_m) {
  std::vector<Pixel> edges;
  constexpr int kMargin = kMaxShift_px + kReach + 1;
  for (int y = kMargin; y + kMargin < depth_m.height; ++y) {
    for (int x = kMargin; x + kMargin < depth_m.width; ++x) {
      if (jumps(depth_m(x - kReach, y), depth_m(x + kReach, y)) ||
          jumps(depth_m(x, y - kReach), depth_m(x, y + kReach)))
        edges.push_back({x, y});
    }
  }
  if (edges.size() <= kMaxEdges) return edges;
  std::vector<Pixel> fewer;
  for (std::size_t i = 0; i < kMaxEdges; ++i) fewer.push_back(edges[i * edges.size() / kMaxEdges]);
  return fewer;
}

/// |dx| + |dy| over two pixels.
double gradient(const GreyImage& grey, int x, int y) {
  return std::abs(grey(x + 1, y) - grey(x - 1, y)) + std::abs(grey(x, y + 1) - grey(x, y - 1));
}

FrameScores score_frame(const RgbdFrame& frame) {
  FrameScores result;
  const std::vector<Pixel> edges = depth_edges(frame.depth_m);
  result.edges = edges.size();
  for (int j = 0; j < kShifts; ++j) {
    for (int i = 0; i < kShifts; ++i) {
      const int dx = i * kStep_px - kMaxShift_px, dy = j * kStep_px - kMaxShift_px;
      double sum = 0;
      for (const Pixel& edge : edges) sum += gradient(frame.grey, edge.x + dx, edge.y + dy);
      result.sums[static_cast<std::size_t>(j * kShifts + i)] = sum;
    }
  }
  return result;
}

FrameScores score_frames(const Recording& recording, const Workers& workers) {
  const std::size_t frames = recording.frames.size();
  const std::size_t count = std::min(frames, kFrames);
  const auto scored = workers.map_chunks<FrameScores>(count, 1, [&](std::size_t i, std::size_t) {
    const auto frame = recording.load_frame(i * frames / count);
    return frame ? score_frame(*frame) : FrameScores{};
  });
  FrameScores all;
  for (const FrameScores& frame : scored) {
    all.edges += frame.edges;
    for (std::size_t i = 0; i < all.sums.size(); ++i) all.sums[i] += frame.sums[i];
  }
  return all;
}

}  // namespace

void check_registration(const Recording& recording, const Workers& workers, Inspection& out) {
  // Depth at a wrong scale is registered wrongly, too, and that has been said.
  if (out.images.empty() || out.has("depth-range") || out.has("depth-scale")) return;
  const FrameScores scores = score_frames(recording, workers);
  if (scores.edges < kMinEdges) return;
  const auto best = std::ranges::max_element(scores.sums);
  const auto index = static_cast<int>(best - scores.sums.begin());
  double mean = 0;
  for (const double sum : scores.sums) mean += sum / static_cast<double>(scores.sums.size());
  const double unshifted = scores.sums[scores.sums.size() / 2];
  RegistrationMeasurement& measured = out.registration;
  measured.shift_x_px = index % kShifts * kStep_px - kMaxShift_px;
  measured.shift_y_px = index / kShifts * kStep_px - kMaxShift_px;
  measured.gain = *best / std::max(1.0, unshifted);
  measured.contrast = *best / std::max(1.0, mean);
  measured.edges = scores.edges;
  const bool away = std::max(std::abs(measured.shift_x_px), std::abs(measured.shift_y_px)) > kTolerance_px;
  if (!away || measured.gain < 1.2 || measured.contrast < 1.25) return;
  out.add("depth-misregistered", Severity::warning,
          fmt::format("edges of depth lie best on edges of colour when depth is shifted by ({}, {}) pixels",
                      measured.shift_x_px, measured.shift_y_px),
          "check T_color_depth and the intrinsics of the depth camera in calibration.toml, and that depth is "
          "registered");
}

}  // namespace fusebench
