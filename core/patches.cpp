#include "core/patches.hpp"

#include <cmath>

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

/// True if the model's surface can stand for what the camera sees at the pixel.
bool is_usable(const SurfacePoint& surface, const ReferenceFrame& frame, const Vector2d& pixel_px,
               const Config& config) {
  if (!surface.valid) return false;
  const Vector3d ray =
      frame.T_world_camera.rotation * frame.camera.back_project(pixel_px.x(), pixel_px.y(), 1.0).normalized();
  const double min_cosine = std::cos(radians(config.depth.max_incidence_deg));
  if (-ray.dot(surface.normal_world) < min_cosine) return false;
  const double measured_m = frame.depth_m(static_cast<int>(pixel_px.x()), static_cast<int>(pixel_px.y()));
  const double allowed_m =
      std::max(config.patches.occlusion_distance_m, 3.0 * depth_sigma_m(surface.depth_m, config.depth));
  return measured_m <= 0 || std::abs(measured_m - surface.depth_m) <= allowed_m;
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
  const std::vector<SurfacePoint> surfaces =
      raycast_pixels(model, frame.camera, frame.T_world_camera, pixels, config.depth, workers);

  std::vector<Patch> patches(centres.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].centre_px = {static_cast<int>(std::lround(centres[p].pixel_px.x())),
                            static_cast<int>(std::lround(centres[p].pixel_px.y()))};
    patches[p].age = centres[p].age;
    patches[p].levels.resize(frame.pyramid.size());
  }
  for (const Request& r : requests) {
    const std::size_t i = r.surface;
    if (!is_usable(surfaces[i], frame, pixels[i], config)) continue;
    PatchPixel pixel;
    pixel.reference_pixel =
        static_cast<std::uint32_t>(pixels[i].y()) * static_cast<std::uint32_t>(frame.camera.width_px) +
        static_cast<std::uint32_t>(pixels[i].x());
    pixel.intensity = frame.pyramid[r.level](r.x, r.y);
    pixel.point_world =
        frame.T_world_camera * frame.camera.back_project(pixels[i].x(), pixels[i].y(), surfaces[i].depth_m);
    pixel.normal_world = surfaces[i].normal_world;
    // A pixel of a coarse level is a mean over what lies about its own size around it.
    const int reach_px = r.level == 0 ? 0 : 1 << r.level;
    pixel.depth_confirmed = is_one_surface(frame.depth_m, static_cast<int>(pixels[i].x()),
                                           static_cast<int>(pixels[i].y()), reach_px, config.depth.edge_jump);
    patches[r.patch].levels[r.level].pixels.push_back(pixel);
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
      const Voxel* voxel = model.find_voxel(lattice.array().round().cast<int>());
      if (voxel == nullptr || !(voxel->weight > 0)) continue;
      const double weight = model.measurement_weight((T_camera_world * pixel.point_world).z(), depth);
      sum += std::min(1.0, weight / static_cast<double>(voxel->weight));
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace fusebench
