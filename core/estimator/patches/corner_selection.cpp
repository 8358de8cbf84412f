#include "core/estimator/patches/corner_selection.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <tuple>

#include "core/config/groups/patches_config.hpp"

namespace fusebench::patches {

namespace {

struct Corner {
  Eigen::Vector2i pixel;
  float score = 0;
  int cell = 0;
};

/// Grid of square cells, about one for each patch.
struct Grid {
  Grid(const GreyImage& grey, int cells) {
    const double area = static_cast<double>(grey.width) * grey.height / std::max(1, cells);
    side_px = std::max(4, static_cast<int>(std::ceil(std::sqrt(area))));
    columns = (grey.width + side_px - 1) / side_px;
  }
  [[nodiscard]] int cell(const Eigen::Vector2i& p) const {
    return p.y() / side_px * columns + p.x() / side_px;
  }
  int side_px = 0;
  int columns = 0;
};

std::vector<Corner> detect(const GreyImage& grey, const Grid& grid, const config::PatchConfig& config) {
  const cv::Mat view(grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.data.data()));
  std::vector<cv::KeyPoint> keypoints;
  cv::FAST(view, keypoints, config.fast_threshold, true);
  std::vector<Corner> corners;
  corners.reserve(keypoints.size());
  for (const cv::KeyPoint& keypoint : keypoints) {
    const Eigen::Vector2i pixel(static_cast<int>(keypoint.pt.x), static_cast<int>(keypoint.pt.y));
    if (patch_fits(grey, pixel, config.size_px))
      corners.push_back({pixel, keypoint.response, grid.cell(pixel)});
  }
  // Total order, so that the result does not depend on the order of the detector.
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::make_tuple(-a.score, a.pixel.y(), a.pixel.x()) <
           std::make_tuple(-b.score, b.pixel.y(), b.pixel.x());
  });
  return corners;
}

bool has_depth(const DepthImage& depth_m, const Eigen::Vector2i& centre, const config::PatchConfig& config) {
  const int half = config.size_px / 2;
  int valid = 0;
  for (int y = centre.y() - half; y < centre.y() - half + config.size_px; ++y) {
    for (int x = centre.x() - half; x < centre.x() - half + config.size_px; ++x) {
      valid += depth_m(x, y) > 0 ? 1 : 0;
    }
  }
  return valid >= config.min_valid_fraction * config.size_px * config.size_px;
}

}  // namespace

bool patch_fits(const GreyImage& grey, const Eigen::Vector2i& centre, int size_px) {
  const int margin = size_px / 2 + 2;
  return centre.x() >= margin && centre.y() >= margin && centre.x() < grey.width - margin &&
         centre.y() < grey.height - margin;
}

std::vector<Eigen::Vector2i> select_corners(const GreyImage& grey, const DepthImage& depth_m,
                                            std::span<const Eigen::Vector2i> existing,
                                            const config::PatchConfig& config) {
  const Grid grid(grey, config.max_count);
  const std::vector<Corner> corners = detect(grey, grid, config);
  std::vector<Eigen::Vector2i> taken(existing.begin(), existing.end());
  const auto cells = static_cast<std::size_t>(grid.cell({grey.width - 1, grey.height - 1}) + 1);
  std::vector<bool> occupied(cells, false);
  for (const Eigen::Vector2i& p : existing) occupied[static_cast<std::size_t>(grid.cell(p))] = true;

  const auto far_from_others = [&](const Eigen::Vector2i& p) {
    const int reach = config.min_distance_px * config.min_distance_px;
    return std::none_of(taken.begin(), taken.end(),
                        [&](const Eigen::Vector2i& q) { return (p - q).squaredNorm() < reach; });
  };
  // First pass: one corner in each cell, for an even distribution. Second pass: the strongest remaining
  // corners.
  for (const bool one_per_cell : {true, false}) {
    for (const Corner& corner : corners) {
      if (static_cast<int>(taken.size()) >= config.max_count) break;
      const auto cell = static_cast<std::size_t>(corner.cell);
      if (one_per_cell && occupied[cell]) continue;
      if (!far_from_others(corner.pixel) || !has_depth(depth_m, corner.pixel, config)) continue;
      taken.push_back(corner.pixel);
      occupied[cell] = true;
    }
  }
  return {taken.begin() + static_cast<std::ptrdiff_t>(existing.size()), taken.end()};
}

}  // namespace fusebench::patches
