#include "core/baselines/elasticfusion/surfels/index_map.hpp"

#include <cmath>

namespace fusebench::baselines::elasticfusion::surfels {

void IndexMap::build(const SurfelMap& map, const PinholeCamera& camera, const SE3& T_world_camera,
                     const SurfelChoice& choice, const Workers& workers) {
  visible_.find(map, camera, T_world_camera, choice, workers);
  cells_.resize(kScale * camera.width_px, kScale * camera.height_px);
  bytes_of_row_ = static_cast<std::size_t>(cells_.width + 7) / 8;
  taken_.resize(bytes_of_row_ * static_cast<std::size_t>(cells_.height) + 1);
  const auto surfels = visible_.all();
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  workers.for_chunks(visible_.bands(), 1, [&](std::size_t band, std::size_t /*end*/) {
    const int first = kScale * VisibleSurfels::kBandRows * static_cast<int>(band);
    const int last = std::min(cells_.height, first + kScale * VisibleSurfels::kBandRows);
    std::fill(taken_.begin() + static_cast<std::ptrdiff_t>(taken_byte(0, first)),
              taken_.begin() + static_cast<std::ptrdiff_t>(taken_byte(0, last)), std::uint8_t{0});
    visible_.for_band(band, [&](std::size_t i) {
      const Eigen::Vector3f& p = surfels[i].position;
      const float u = std::floor((fx * p.x() / p.z() + cx + 0.5F) * kScale);
      const float v = std::floor((fy * p.y() / p.z() + cy + 0.5F) * kScale);
      if (!(u >= 0) || !(u < static_cast<float>(cells_.width))) return;
      if (!(v >= static_cast<float>(first)) || !(v < static_cast<float>(last))) return;
      const int column = static_cast<int>(u), row = static_cast<int>(v);
      std::uint8_t& taken = taken_[taken_byte(column, row)];
      const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(column % 8));
      std::int32_t& cell = cells_(column, row);
      if ((taken & bit) == 0 || p.z() < surfels[static_cast<std::size_t>(cell)].position.z())
        cell = static_cast<std::int32_t>(i);
      taken |= bit;
    });
  });
}

}  // namespace fusebench::baselines::elasticfusion::surfels
