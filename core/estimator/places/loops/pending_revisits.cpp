#include "core/estimator/places/loops/pending_revisits.hpp"

#include <algorithm>
#include <cmath>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/estimator/model/raycast/raycast.hpp"
#include "core/estimator/model/tsdf/tsdf_lanes.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::loops {

namespace {

constexpr int kCell_px = 16;
constexpr double kLeastShare = 0.05;  // of the cells, and of the visible cells
constexpr double kLeastMisfit_m = 0.01;
constexpr double kMisfitSigmas = 2.0;

int cells(int pixels) { return (pixels + kCell_px - 1) / kCell_px; }
int middle_px(int cell, int pixels) { return std::min(cell * kCell_px + kCell_px / 2, pixels - 1); }

}  // namespace

/// Casts rays through the centres of the cells.
void PendingRevisits::look(const tsdf::TsdfVolume& model, const RgbdFrame& frame, const SE3& T_world_camera,
                           const Workers& workers) {
  const int columns = cells(camera_.width_px);
  const int rows = cells(camera_.height_px);
  old_.assign(static_cast<std::size_t>(columns * rows), false);
  misfits_.clear();
  const auto field = tsdf::field_in_view(model, camera_, T_world_camera, depth_);
  if (!field) return;
  std::vector<raycast::PixelRay> rays;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      rays.push_back({static_cast<double>(middle_px(column, camera_.width_px)),
                      static_cast<double>(middle_px(row, camera_.height_px))});
  }
  raycast::raycast_pixels(*field, camera_, T_world_camera, rays, depth_, workers, surfaces_);
  for (std::size_t cell = 0; cell < rays.size(); ++cell) {
    const raycast::SurfacePoint& surface = surfaces_[cell];
    const raycast::PixelRay& ray = rays[cell];
    if (!surface.valid) continue;
    const auto place =
        model.nearest_voxel(T_world_camera * camera_.back_project(ray.u_px, ray.v_px, surface.depth_m));
    if (!place || seconds_between(model.last_fused_ns(place->slot), frame.timestamp_ns) < loops_.least_age_s)
      continue;
    old_[cell] = true;
    const auto measured_m =
        static_cast<double>(frame.depth_m(static_cast<int>(ray.u_px), static_cast<int>(ray.v_px)));
    if (!(measured_m > 0)) continue;
    const double allowed_m =
        std::max(kLeastMisfit_m, kMisfitSigmas * preprocessing::depth_sigma_m(measured_m, depth_));
    misfits_.push_back(std::abs(measured_m - surface.depth_m) / allowed_m);
  }
}

bool PendingRevisits::do_not_fit() const {
  if (static_cast<double>(misfits_.size()) < kLeastShare * static_cast<double>(old_.size())) return false;
  const auto apart = std::ranges::count_if(misfits_, [](double misfit) { return misfit > 1.0; });
  return 2 * static_cast<std::size_t>(apart) > misfits_.size();
}

std::optional<DepthImage> PendingRevisits::depth_to_fuse(const tsdf::TsdfVolume& model,
                                                         const RgbdFrame& frame, const SE3& T_world_camera,
                                                         const Workers& workers) {
  if (loops_.max_pending_s == 0) return std::nullopt;  // the result would not be used
  look(model, frame, T_world_camera, workers);
  if (!do_not_fit()) {
    pending_since_ns_.reset();
    return std::nullopt;
  }
  if (!pending_since_ns_) pending_since_ns_ = frame.timestamp_ns;
  if (seconds_between(*pending_since_ns_, frame.timestamp_ns) >= loops_.max_pending_s) return std::nullopt;
  DepthImage rest_m = frame.depth_m;
  const int columns = cells(camera_.width_px);
  for (int y = 0; y < rest_m.height; ++y) {
    for (int x = 0; x < rest_m.width; ++x) {
      const int cell = y / kCell_px * columns + x / kCell_px;
      if (old_[static_cast<std::size_t>(cell)]) rest_m(x, y) = 0;
    }
  }
  return rest_m;
}

}  // namespace fusebench::loops
