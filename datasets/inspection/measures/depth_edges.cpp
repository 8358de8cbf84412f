#include "datasets/inspection/measures/depth_edges.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fusebench::inspection::measures {

namespace {

constexpr std::size_t kMaxEdges = 500;  // of one frame
constexpr int kMaxHole_px = 8;
constexpr float kJump = 0.1F;  // of the nearer depth
constexpr int kSurroundings_px = 16;
constexpr float kHalfStrength_grey = 6;  // gradient per pixel with half of the greatest strength
// Wider than the noise of depth's edges, so that the strength is a smooth function of the model.
constexpr double kBlur_px = 1.5;

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

void blur(EdgeStrength& strength) {
  for (std::vector<float>* values : {&strength.upright, &strength.level}) {
    cv::Mat image(strength.height, strength.width, CV_32F, values->data());
    cv::GaussianBlur(image, image, {}, kBlur_px);
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
                     static_cast<float>(y) + (upright ? 0 : beside_px), nearer_m, upright, here_m < there_m});
    return;
  }
}

FrameEdges frame_edges(const RgbdFrame& frame) {
  FrameEdges out;
  std::vector<DepthEdge> edges = depth_edges(frame.depth_m);
  const std::size_t count = std::min(edges.size(), kMaxEdges);
  for (std::size_t i = 0; i < count; ++i) out.edges.push_back(edges[i * edges.size() / count]);
  out.strength[0] = edge_strength(frame.grey);
  for (std::size_t level = 1; level < kStrengthLevels; ++level)
    out.strength[level] = halved(out.strength[level - 1]);
  for (std::size_t level = 0; level < kStrengthLevels; ++level)
    subtract_local_mean(out.strength[level], kSurroundings_px >> level);
  blur(out.strength[0]);
  return out;
}

/// A quarter of the size, of floats.
cv::Mat small_image(const GreyImage& grey) {
  constexpr double kShrink = 0.25;
  // OpenCV has no read-only view; nothing writes through this one.
  const cv::Mat view(grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.data.data()));
  cv::Mat image;
  view.convertTo(image, CV_32F);
  cv::resize(image, image, {}, kShrink, kShrink, cv::INTER_AREA);
  return image;
}

/// By phase correlation.
Vector2d edge_motion_px(const GreyImage& from, const GreyImage& to) {
  const cv::Mat a = small_image(from), b = small_image(to);
  cv::Mat window;
  cv::createHanningWindow(window, a.size(), CV_32F);
  const cv::Point2d moved = cv::phaseCorrelate(a, b, window);
  return {moved.x * from.width / a.cols, moved.y * from.height / a.rows};
}

}  // namespace

StrengthSample EdgeStrength::at(const std::vector<float>& values, double x, double y) const {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double fx = x - x0, fy = y - y0;
  const float* row = values.data() + static_cast<std::ptrdiff_t>(y0) * width + x0;
  const double a = row[0], b = row[1], c = row[width], d = row[width + 1];
  return {(1 - fy) * ((1 - fx) * a + fx * b) + fy * ((1 - fx) * c + fx * d),
          {(1 - fy) * (b - a) + fy * (d - c), (1 - fx) * (c - a) + fx * (d - b)}};
}

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

std::vector<FrameEdges> load_edges(const recording::Recording& recording, std::size_t most_frames,
                                   const Workers& workers) {
  const std::size_t frames = recording.frames.size();
  const std::size_t count = std::min(frames, most_frames);
  return workers.map_chunks<FrameEdges>(count, 1, [&](std::size_t i, std::size_t) {
    const std::size_t k = i * frames / count;
    const auto frame = recording.load_frame(k);
    if (!frame) return FrameEdges{};
    FrameEdges result = frame_edges(*frame);
    if (k + 1 == frames) return result;
    if (const auto next = recording.load_frame(k + 1))
      result.motion_px = edge_motion_px(frame->grey, next->grey);
    return result;
  });
}

}  // namespace fusebench::inspection::measures
