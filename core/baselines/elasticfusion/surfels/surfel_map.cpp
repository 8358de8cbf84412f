#include "core/baselines/elasticfusion/surfels/surfel_map.hpp"

#include "core/base/error.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

namespace {

template <class Value>
void remove_flagged(std::span<const std::uint8_t> flags, std::vector<Value>& values) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] != 0) continue;
    if (kept != i) values[kept] = values[i];
    ++kept;
  }
  values.resize(kept);
}

}  // namespace

Surfel SurfelMap::at(std::size_t index) const {
  return {position[index],   normal[index],  color[index],  radius_m[index],
          confidence[index], created[index], updated[index]};
}

void SurfelMap::add(const Surfel& surfel) {
  position.push_back(surfel.position);
  normal.push_back(surfel.normal);
  color.push_back(surfel.color);
  radius_m.push_back(surfel.radius_m);
  confidence.push_back(surfel.confidence);
  created.push_back(surfel.created);
  updated.push_back(surfel.updated);
}

void SurfelMap::set(std::size_t index, const Surfel& surfel) {
  position[index] = surfel.position;
  normal[index] = surfel.normal;
  color[index] = surfel.color;
  radius_m[index] = surfel.radius_m;
  confidence[index] = surfel.confidence;
  created[index] = surfel.created;
  updated[index] = surfel.updated;
}

void SurfelMap::remove(std::span<const std::uint8_t> flags) {
  check(flags.size() == size(), "one flag a surfel");
  remove_flagged(flags, position);
  remove_flagged(flags, normal);
  remove_flagged(flags, color);
  remove_flagged(flags, radius_m);
  remove_flagged(flags, confidence);
  remove_flagged(flags, created);
  remove_flagged(flags, updated);
}

}  // namespace fusebench::baselines::elasticfusion::surfels
