#include "core/patches.hpp"

#include <cmath>
#include <optional>
#include <span>

#include "core/corner_selection.hpp"
#include "core/depth_gates.hpp"
#include "core/patch_deformation.hpp"
#include "core/raycast.hpp"

namespace fusebench {

namespace {

/// A pixel of a level that needs its surface: where it is in the level, and which of the pixels of level 0.
struct Request {
  std::size_t patch = 0;
  std::size_t level = 0;
  int x = 0;  ///< level pixels
  int y = 0;
  std::size_t surface = 0;  ///< number of its pixel of level 0
};

/// What squares need: many ask for the same pixel, those of other levels and of neighbours.
struct Requests {
  std::vector<Request> requests;    ///< by patch, level, row, column
  std::vector<Vector2d> pixels_px;  ///< level 0, each once
};

/// All pixels of the squares around the centres at all levels.
Requests requests_of(std::span<const TrackedCentre> centres, const ReferenceFrame& frame, int size_px) {
  Requests result;
  constexpr std::uint32_t kNew = 0;
  const GreyImage& full = frame.pyramid[0];
  Image<std::uint32_t> numbers(full.width, full.height, kNew);  // of the pixels, from 1
  const auto number_of = [&](int x, int y) -> std::size_t {
    std::uint32_t& number = numbers(x, y);
    if (number == kNew) {
      result.pixels_px.emplace_back(x, y);
      number = static_cast<std::uint32_t>(result.pixels_px.size());
    }
    return number - 1;
  };
  for (std::size_t p = 0; p < centres.size(); ++p) {
    for (std::size_t l = 0; l < frame.pyramid.size(); ++l) {
      const GreyImage& image = frame.pyramid[l];
      const double scale = static_cast<double>(1 << l);
      const int x0 = static_cast<int>(std::lround(centres[p].pixel_px.x() / scale)) - size_px / 2;
      const int y0 = static_cast<int>(std::lround(centres[p].pixel_px.y() / scale)) - size_px / 2;
      for (int y = y0; y < y0 + size_px; ++y) {
        for (int x = x0; x < x0 + size_px; ++x) {
          // A coarse square may reach over the border, and its last row beyond level 0's.
          if (image.contains(x, y) && full.contains(x << l, y << l))
            result.requests.push_back({p, l, x, y, number_of(x << l, y << l)});
        }
      }
    }
  }
  return result;
}

/// The surfaces behind pixels, each looked for where it would be usable: around what was measured, or all
/// along the ray.
std::vector<SurfacePoint> surfaces_at(const std::vector<Vector2d>& pixels_px, const ReferenceFrame& frame,
                                      const TsdfVolume& model, const Config& config, const Workers& workers) {
  // A surface at the far end of what usable_surfaces() allows has more noise than one at the measurement.
  constexpr double kMargin = 1.5;
  // Short rays first, so that they do not wait for long ones beside them.
  std::vector<PixelRay> rays;
  std::vector<PixelRay> long_rays;
  std::vector<std::size_t> pixels;  // of the rays
  std::vector<std::size_t> pixels_of_long;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const Vector2d& pixel_px = pixels_px[i];
    const double measured_m = frame.depth_m(static_cast<int>(pixel_px.x()), static_cast<int>(pixel_px.y()));
    PixelRay ray{pixel_px.x(), pixel_px.y()};
    if (measured_m <= 0) {
      long_rays.push_back(ray);
      pixels_of_long.push_back(i);
      continue;
    }
    const double reach_m = kMargin * std::max(config.patches.occlusion_distance_m,
                                              3.0 * depth_sigma_m(measured_m, config.depth));
    ray.begin_m = static_cast<float>(measured_m - reach_m);
    ray.end_m = static_cast<float>(measured_m + reach_m);
    rays.push_back(ray);
    pixels.push_back(i);
  }
  rays.insert(rays.end(), long_rays.begin(), long_rays.end());
  pixels.insert(pixels.end(), pixels_of_long.begin(), pixels_of_long.end());
  std::vector<SurfacePoint> hits;
  raycast_pixels(model, frame.camera, frame.T_world_camera, rays, config.depth, workers, hits);
  std::vector<SurfacePoint> surfaces(pixels_px.size());
  for (std::size_t i = 0; i < hits.size(); ++i) surfaces[pixels[i]] = hits[i];
  return surfaces;
}

/// What the model says of a pixel, if it can stand for what the camera sees there.
struct UsableSurface {
  bool valid = false;
  Vector3d point_world = Vector3d::Zero();
  Vector3d normal_world = Vector3d::Zero();
};

std::vector<UsableSurface> usable_surfaces(std::span<const SurfacePoint> surfaces,
                                           const std::vector<Vector2d>& pixels_px,
                                           const ReferenceFrame& frame, const Config& config) {
  const Matrix3d R_world_camera = frame.T_world_camera.rotation_matrix();
  const double min_cosine = std::cos(radians(config.depth.max_incidence_deg));
  std::vector<UsableSurface> usable(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const SurfacePoint& surface = surfaces[i];
    if (!surface.valid) continue;
    const Vector2d& pixel_px = pixels_px[i];
    const Vector3d from_camera =
        R_world_camera * frame.camera.back_project(pixel_px.x(), pixel_px.y(), surface.depth_m);
    if (-from_camera.dot(surface.normal_world) < min_cosine * from_camera.norm()) continue;
    const double measured_m = frame.depth_m(static_cast<int>(pixel_px.x()), static_cast<int>(pixel_px.y()));
    const double allowed_m =
        std::max(config.patches.occlusion_distance_m, 3.0 * depth_sigma_m(surface.depth_m, config.depth));
    if (measured_m > 0 && std::abs(measured_m - surface.depth_m) > allowed_m) continue;
    usable[i] = {true, frame.T_world_camera.translation + from_camera, surface.normal_world};
  }
  return usable;
}

/// Where a patch has measured depth, its pixels without are at an edge or in the shadow of one. A patch
/// without any lies in a hole, or the camera has no depth: there the model's surface has to do.
void trust_model_in_holes(Patch& patch) {
  for (const PatchLevel& level : patch.levels) {
    for (const PatchPixel& pixel : level.pixels) {
      if (pixel.depth_confirmed) return;
    }
  }
  for (PatchLevel& level : patch.levels) {
    for (PatchPixel& pixel : level.pixels) pixel.depth_confirmed = true;
  }
}

/// Patches with the pixels that have a usable surface.
std::vector<Patch> cut_patches(const ReferenceFrame& frame, const TsdfVolume& model,
                               std::span<const TrackedCentre> centres, const Config& config,
                               const Workers& workers) {
  const auto [requests, pixels] = requests_of(centres, frame, config.patches.size_px);
  const std::vector<UsableSurface> surfaces =
      usable_surfaces(surfaces_at(pixels, frame, model, config, workers), pixels, frame, config);

  const auto square =
      static_cast<std::size_t>(config.patches.size_px) * static_cast<std::size_t>(config.patches.size_px);
  std::vector<Patch> patches(centres.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].centre_px = {static_cast<int>(std::lround(centres[p].pixel_px.x())),
                            static_cast<int>(std::lround(centres[p].pixel_px.y()))};
    patches[p].age = centres[p].age;
    patches[p].levels.resize(frame.pyramid.size());
  }
  for (const Request& r : requests) {
    const std::size_t i = r.surface;
    if (!surfaces[i].valid) continue;
    std::vector<PatchPixel>& level = patches[r.patch].levels[r.level].pixels;
    if (level.empty()) level.reserve(square);
    PatchPixel& pixel = level.emplace_back();
    const int x = static_cast<int>(pixels[i].x());
    const int y = static_cast<int>(pixels[i].y());
    pixel.reference_pixel =
        static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(frame.camera.width_px) +
        static_cast<std::uint32_t>(x);
    pixel.intensity = frame.pyramid[r.level](r.x, r.y);
    pixel.point_world = surfaces[i].point_world;
    pixel.normal_world = surfaces[i].normal_world;
    // A pixel of a coarse level is a mean over what lies about its own size around it.
    const int reach_px = r.level == 0 ? 0 : 1 << r.level;
    pixel.depth_confirmed = is_one_surface(frame.depth_m, x, y, reach_px, config.depth.edge_jump);
  }
  for (Patch& patch : patches) trust_model_in_holes(patch);
  return patches;
}

/// Survivors that are still inside and apart from each other, oldest first.
std::vector<TrackedCentre> keep_apart(std::span<const TrackedCentre> survivors, const ReferenceFrame& frame,
                                      const PatchConfig& config) {
  std::vector<TrackedCentre> kept;
  // Patches drift towards each other; half the detection distance keeps their squares from overlapping.
  const double reach = std::max(0.5 * config.min_distance_px, static_cast<double>(config.size_px));
  for (const TrackedCentre& candidate : survivors) {
    const Eigen::Vector2i pixel(static_cast<int>(std::lround(candidate.pixel_px.x())),
                                static_cast<int>(std::lround(candidate.pixel_px.y())));
    bool free = patch_fits(frame.pyramid[0], pixel, config.size_px);
    for (const TrackedCentre& other : kept) {
      free = free && (other.pixel_px - candidate.pixel_px).squaredNorm() >= reach * reach;
    }
    if (free && static_cast<int>(kept.size()) < config.max_count) kept.push_back(candidate);
  }
  return kept;
}

}  // namespace

std::vector<Patch> refresh_patches(const ReferenceFrame& frame, const TsdfVolume& model,
                                   std::span<const TrackedCentre> survivors, const Config& config,
                                   const Workers& workers) {
  std::vector<TrackedCentre> centres = keep_apart(survivors, frame, config.patches);
  std::vector<Eigen::Vector2i> existing;
  for (const TrackedCentre& c : centres) {
    existing.emplace_back(static_cast<int>(std::lround(c.pixel_px.x())),
                          static_cast<int>(std::lround(c.pixel_px.y())));
  }
  for (const Eigen::Vector2i& corner :
       select_corners(frame.pyramid[0], frame.depth_m, existing, config.patches)) {
    centres.push_back({corner.cast<double>(), 0});
  }

  std::vector<Patch> patches = cut_patches(frame, model, centres, config, workers);
  const int square = config.patches.size_px * config.patches.size_px;
  const auto too_few = [&](const Patch& patch) {
    const auto usable = static_cast<int>(patch.levels.front().pixels.size());
    return usable < config.patches.min_valid_px || usable < config.patches.min_valid_fraction * square;
  };
  std::erase_if(patches, too_few);
  for (Patch& patch : patches) {
    set_deformation(patch, frame.camera, frame.T_world_camera, config.terms.deformation);
  }
  std::erase_if(patches, too_few);  // a deformation may find no plane or no centre
  return patches;
}

double fused_share(const TsdfVolume& model, std::span<const Patch> patches, const ReferenceFrame& frame,
                   const DepthConfig& depth) {
  const SE3 T_camera_world = frame.T_world_camera.inverse();
  double sum = 0;
  std::size_t count = 0;
  for (const Patch& patch : patches) {
    for (const PatchPixel& pixel : patch.levels.front().pixels) {
      ++count;
      if (!(frame.depth_m.data[pixel.reference_pixel] > 0)) continue;
      const Vector3d lattice = pixel.point_world / model.voxel_m();
      const std::optional<Voxel> voxel = model.find_voxel(lattice.array().round().cast<int>());
      if (!voxel || !(voxel->weight > 0)) continue;
      const double weight = model.measurement_weight((T_camera_world * pixel.point_world).z(), depth);
      sum += std::min(1.0, weight / static_cast<double>(voxel->weight));
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace fusebench
