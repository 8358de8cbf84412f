// The surfel map: oriented discs in the world with their attributes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// One surfel; position and normal in the world, times as frame numbers.
struct Surfel {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< metres
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, towards the cameras that observed it
  Rgb color{};
  float radius_m = 0;
  float confidence = 0;
  std::int32_t created = 0;
  std::int32_t updated = 0;
};

/// All surfels as one array for each attribute, in the order of creation.
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
  /// Removes the surfels whose flag is not 0 and keeps the order. One flag for each surfel.
  void remove(std::span<const std::uint8_t> flags);
};

/// Selection of surfels by time and confidence.
struct SurfelChoice {
  std::int32_t now = 0;      ///< number of the frame
  std::int32_t window = 0;   ///< active: updated within this number of frames
  bool active = true;        ///< selects active or inactive surfels
  float min_confidence = 0;  ///< exclusive limit

  [[nodiscard]] bool takes(const SurfelMap& map, std::size_t index) const {
    return (now - map.updated[index] <= window) == active && map.confidence[index] > min_confidence;
  }
};

}  // namespace fusebench::baselines::elasticfusion::surfels
