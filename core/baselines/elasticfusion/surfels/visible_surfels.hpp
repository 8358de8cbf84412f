// Surfels in the frame of a camera, sorted by the image rows that they may cover. Threads draw separate
// bands, and each pixel processes its surfels in a fixed order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// In the camera's frame.
struct CameraSurfel {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  float radius_m;
  std::uint32_t index;  ///< in the map
  // Range of pixels that it may cover, inclusive.
  std::int16_t left, right, top, bottom;
};

class VisibleSurfels {
 public:
  static constexpr int kBandRows = 16;  ///< the last band may have fewer

  /// Finds the selected surfels whose disc may reach the image, in the order of the map.
  void find(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
            const SurfelChoice& choice, const Workers& workers);

  [[nodiscard]] std::span<const CameraSurfel> all() const { return all_; }
  [[nodiscard]] std::size_t bands() const { return bands_; }

  /// Calls draw(i) for each surfel i of all() that may reach the band, in order.
  template <class Draw>
  void for_band(std::size_t band, const Draw& draw) const {
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      for (const std::uint32_t i : parts_[part].of_band[band]) draw(parts_[part].first + i);
    }
  }

 private:
  struct Part {
    std::vector<CameraSurfel> surfels;
    std::vector<std::vector<std::uint32_t>> of_band;
    std::size_t first = 0;  ///< index of its first surfel in all()
  };

  std::size_t bands_ = 0;
  std::vector<Part> parts_;
  std::vector<CameraSurfel> all_;
};

}  // namespace fusebench::baselines::elasticfusion::surfels
