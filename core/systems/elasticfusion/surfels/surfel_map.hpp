// The model: oriented discs in the world, with what is known of each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::systems::elasticfusion::surfels {

/// One disc; positions and normals in the world, times as numbers of frames.
struct Surfel {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< metres
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, towards the cameras that saw it
  Rgb color{};
  float radius_m = 0;
  float confidence = 0;
  std::int32_t created = 0;
  std::int32_t updated = 0;
};

/// All discs, attribute by attribute, in the order in which they were created.
struct SurfelMap {
  std::vector<Eigen::Vector3f> position;
  std::vector<Eigen::Vector3f> normal;
  std::vector<Rgb> color;
  std::vector<float> radius_m;
  std::vector<float> confidence;
  std::vector<std::int32_t> created;
  std::vector<std::int32_t> updated;

  [[nodiscard]] std::size_t size() const { return position.size(); }
  [[nodiscard]] Surfel at(std::size_t index) const;
  void add(const Surfel& surfel);
  void set(std::size_t index, const Surfel& surfel);
  /// Removes those whose flag is not 0; the others stay in their order. One flag a surfel.
  void remove(std::span<const std::uint8_t> flags);
};

/// Some of the surfels, by time and confidence.
struct SurfelChoice {
  std::int32_t now = 0;      ///< number of the frame
  std::int32_t window = 0;   ///< active: updated within so many frames
  bool active = true;        ///< those that are, or those that are not
  float min_confidence = 0;  ///< more than that

  [[nodiscard]] bool takes(const SurfelMap& map, std::size_t index) const {
    return (now - map.updated[index] <= window) == active && map.confidence[index] > min_confidence;
  }
};

}  // namespace fusebench::systems::elasticfusion::surfels
