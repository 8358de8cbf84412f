#include "core/estimator/patches/patches.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/estimator/patches/corner_selection.hpp"
#include "core/estimator/patches/measured_surfaces.hpp"
#include "core/estimator/patches/patch_deformation.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::patches {

namespace {

constexpr std::size_t kPatchesPerChunk = 8;
constexpr std::size_t kMaxLevels = 6;  // limit of patches.levels

/// Geometry of the squares of all patches.
struct Squares {
  /// The first pixel of a square.
  struct Corner {
    int x = 0;  ///< pixels of the level
    int y = 0;
  };

  Squares(std::span<const TrackedCentre> centres_in, const ReferenceFrame& frame_in,
          const CutOptions& options_in)
      : centres(centres_in),
        frame(frame_in),
        options(options_in),
        size_px(options_in.patches.size_px),
        levels(frame_in.pyramid.size()) {}

  [[nodiscard]] Corner corner(std::size_t patch, std::size_t level) const {
    const double scale = static_cast<double>(1 << level);
    const Vector2d& centre_px = centres[patch].pixel_px;
    return {static_cast<int>(std::lround(centre_px.x() / scale)) - size_px / 2,
            static_cast<int>(std::lround(centre_px.y() / scale)) - size_px / 2};
  }
  /// Number of pixels of a square.
  [[nodiscard]] std::size_t area() const {
    return static_cast<std::size_t>(size_px) * static_cast<std::size_t>(size_px);
  }
  /// Index of the first pixel of a square among all pixels, ordered by patch, level, row, column.
  [[nodiscard]] std::size_t first(std::size_t patch, std::size_t level) const {
    return (patch * levels + level) * area();
  }

  /// Search distance around the measured depth. The noise at the far limit of UsableSurface is larger than at
  /// the measurement.
  [[nodiscard]] float reach_m(float measured_m) const {
    constexpr float kMargin = 1.5F;
    const double noise_m = preprocessing::depth_sigma_m(static_cast<double>(measured_m), options.depth);
    return kMargin * static_cast<float>(std::max(options.patches.occlusion_distance_m, 3.0 * noise_m));
  }

  std::span<const TrackedCentre> centres;
  const ReferenceFrame& frame;
  const CutOptions& options;
  int size_px;
  std::size_t levels;
};

/// Appends to `pixels` the level-0 pixels that the squares of a patch need, each once, since levels share
/// pixels. If the finest square has any measured depth, coarse pixels without it are skipped: their colour is
/// not used (use_model_depth_in_holes), and intensity errors use the finest level.
void add_pixels(const Squares& squares, std::size_t patch, PatchWorkspace& work) {
  const GreyImage& full = squares.frame.pyramid[0];
  const int size = squares.size_px;
  std::array<Squares::Corner, kMaxLevels> corners;
  bool measured = false;  // any pixel of the finest square
  for (std::size_t l = 0; l < squares.levels; ++l) {
    const GreyImage& image = squares.frame.pyramid[l];
    const Squares::Corner corner = corners[l] = squares.corner(patch, l);
    std::size_t place = squares.first(patch, l);
    for (int y = corner.y; y < corner.y + size; ++y) {
      for (int x = corner.x; x < corner.x + size; ++x, ++place) {
        std::int32_t& pixel = work.pixel_of[place];
        pixel = -1;
        // A coarse square may cross the border, and its last row may be outside level 0.
        if (!image.contains(x, y) || !full.contains(x << l, y << l)) continue;
        const float measured_m = squares.frame.depth_m(x << l, y << l);
        if (l == 0) measured |= measured_m > 0;
        if (l > 0 && measured && measured_m <= 0) continue;
        for (std::size_t finer = 0; finer < l && pixel < 0; ++finer) {
          const int column = (x << (l - finer)) - corners[finer].x;
          const int row = (y << (l - finer)) - corners[finer].y;
          if (column < 0 || row < 0 || column >= size || row >= size) continue;
          pixel = work.pixel_of[squares.first(patch, finer) + static_cast<std::size_t>(row * size + column)];
        }
        if (pixel >= 0) continue;
        pixel = static_cast<std::int32_t>(work.pixels.size());
        work.pixels.push_back({static_cast<float>(x << l), static_cast<float>(y << l), measured_m,
                               squares.reach_m(measured_m)});
      }
    }
  }
}

bool takes_any_depth(const config::PatchConfig& config) {
  return config.reference_surface == config::ReferenceSurface::frame_ungated;
}

/// Selects the usable surface of a pixel.
class UsableSurface {
 public:
  UsableSurface(const ReferenceFrame& frame, const CutOptions& options)
      : frame_(frame),
        options_(options),
        R_world_camera_(frame.T_world_camera.rotation_matrix()),
        min_cosine_(takes_any_depth(options.patches) ? -1.0
                                                     : std::cos(radians(options.depth.max_incidence_deg))) {}

  [[nodiscard]] std::optional<PatchPixel> operator()(const raycast::ExpectedSurface& pixel,
                                                     const raycast::SurfacePoint& surface) const {
    if (!surface.valid) return std::nullopt;
    const auto u = static_cast<double>(pixel.u_px);
    const auto v = static_cast<double>(pixel.v_px);
    const Vector3d from_camera = R_world_camera_ * frame_.camera.back_project(u, v, surface.depth_m);
    if (-from_camera.dot(surface.normal_world) < min_cosine_ * from_camera.norm()) return std::nullopt;
    const double allowed_m = std::max(options_.patches.occlusion_distance_m,
                                      3.0 * preprocessing::depth_sigma_m(surface.depth_m, options_.depth));
    const auto measured_m = static_cast<double>(pixel.depth_m);
    if (measured_m > 0 && std::abs(measured_m - surface.depth_m) > allowed_m) return std::nullopt;
    PatchPixel usable;
    usable.point_world = frame_.T_world_camera.translation + from_camera;
    usable.normal_world = surface.normal_world.cast<float>();
    usable.reference_pixel =
        static_cast<std::uint32_t>(frame_.depth_m.index(static_cast<int>(u), static_cast<int>(v)));
    return usable;
  }

 private:
  const ReferenceFrame& frame_;
  const CutOptions& options_;
  Matrix3d R_world_camera_;
  double min_cosine_;
};

/// In a patch with measured depth, pixels without it are at an edge or in a shadow and are not used. A patch
/// without any measured depth is in a hole or the camera has no depth; it uses the model's surface.
void use_model_depth_in_holes(Patch& patch) {
  for (const PatchLevel& level : patch.levels) {
    for (const PatchPixel& pixel : level.pixels) {
      if (pixel.depth_confirmed) return;
    }
  }
  for (PatchLevel& level : patch.levels) {
    for (PatchPixel& pixel : level.pixels) pixel.depth_confirmed = true;
  }
}

/// Grey levels of a level-0 square; 0 outside the image (the patch is then dropped).
void copy_square(const GreyImage& image, const Squares::Corner& corner, int size_px,
                 std::vector<std::uint8_t>& grey) {
  grey.clear();
  for (int y = corner.y; y < corner.y + size_px; ++y) {
    for (int x = corner.x; x < corner.x + size_px; ++x)
      grey.push_back(image.contains(x, y) ? image(x, y) : 0);
  }
}

/// Sets the pixels of a patch that have a usable surface.
void fill_patch(const Squares& squares, std::size_t p, const UsableSurface& usable,
                const PatchWorkspace& work, std::span<const raycast::SurfacePoint> surfaces, Patch& patch) {
  const ReferenceFrame& frame = squares.frame;
  const Vector2d& centre_px = squares.centres[p].pixel_px;
  patch.centre_px = {static_cast<int>(std::lround(centre_px.x())),
                     static_cast<int>(std::lround(centre_px.y()))};
  patch.age = squares.centres[p].age;
  copy_square(frame.pyramid.front(), squares.corner(p, 0), squares.size_px, patch.square_grey);
  patch.levels.resize(squares.levels);
  for (std::size_t l = 0; l < squares.levels; ++l) {
    std::vector<PatchPixel>& pixels = patch.levels[l].pixels;
    pixels.clear();
    pixels.reserve(squares.area());
    // A coarse pixel is a mean over an area of about its own size.
    const int reach_px = l == 0 ? 0 : 1 << l;
    for (std::size_t i = 0; i < squares.area(); ++i) {
      const std::int32_t number = work.pixel_of[squares.first(p, l) + i];
      if (number < 0) continue;
      const auto at = static_cast<std::size_t>(number);
      const std::optional<PatchPixel> pixel = usable(work.pixels[at], surfaces[at]);
      if (!pixel) continue;
      const auto x = static_cast<int>(work.pixels[at].u_px);
      const auto y = static_cast<int>(work.pixels[at].v_px);
      pixels.push_back(*pixel);
      pixels.back().intensity = frame.pyramid[l](x >> l, y >> l);
      pixels.back().depth_confirmed =
          takes_any_depth(squares.options.patches) ||
          preprocessing::is_one_surface(frame.depth_m, x, y, reach_px, squares.options.depth.edge_jump);
    }
  }
  use_model_depth_in_holes(patch);
}

/// Surfaces at the pixels of the patches.
std::span<const raycast::SurfacePoint> surfaces_of(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                                                   const CutOptions& options, const Workers& workers,
                                                   PatchWorkspace& work) {
  if (options.patches.reference_surface == config::ReferenceSurface::model)
    return work.surfaces.find(model, frame.camera, frame.T_world_camera, options.depth, work.pixels,
                              work.first, workers);
  work.measured = measured_surfaces(frame.depth_m, frame.camera, frame.T_world_camera, work.pixels);
  return work.measured;
}

/// Cuts patches from the pixels with a usable surface.
void cut_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                 std::span<const TrackedCentre> centres, const CutOptions& options, const Workers& workers,
                 PatchWorkspace& work, std::vector<Patch>& patches) {
  check(frame.pyramid.size() <= kMaxLevels, "a pyramid has at most six levels");
  const Squares squares(centres, frame, options);
  work.pixels.clear();
  work.pixel_of.resize(squares.first(centres.size(), 0));
  work.first.assign(1, 0);
  for (std::size_t p = 0; p < centres.size(); ++p) {
    add_pixels(squares, p, work);
    work.first.push_back(work.pixels.size());
  }
  const std::span<const raycast::SurfacePoint> surfaces = surfaces_of(frame, model, options, workers, work);
  const UsableSurface usable(frame, options);
  patches.resize(centres.size());
  workers.for_chunks(patches.size(), kPatchesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) fill_patch(squares, p, usable, work, surfaces, patches[p]);
  });
}

/// Survivors inside the image that are separated from each other, oldest first.
std::vector<TrackedCentre> select_separated(std::span<const TrackedCentre> survivors,
                                            const ReferenceFrame& frame, const config::PatchConfig& config) {
  std::vector<TrackedCentre> kept;
  // Patches drift towards each other. Half the detection distance prevents overlap.
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

/// True if the pixel of a point has a measured depth.
bool is_measured(const ReferenceFrame& frame, const Vector3d& point_camera) {
  const Vector2d pixel = frame.camera.project(point_camera);
  const auto x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
  return frame.depth_m.contains(x, y) && frame.depth_m(x, y) > 0;
}

}  // namespace

void refresh_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                     std::span<const TrackedCentre> survivors, const CutOptions& options,
                     const Workers& workers, PatchWorkspace& work, std::vector<Patch>& patches) {
  std::vector<TrackedCentre> centres = select_separated(survivors, frame, options.patches);
  std::vector<Eigen::Vector2i> existing;
  for (const TrackedCentre& c : centres) {
    existing.emplace_back(static_cast<int>(std::lround(c.pixel_px.x())),
                          static_cast<int>(std::lround(c.pixel_px.y())));
  }
  for (const Eigen::Vector2i& corner :
       select_corners(frame.pyramid[0], frame.depth_m, existing, options.patches)) {
    centres.push_back({corner.cast<double>(), 0});
  }
  cut_patches(frame, model, centres, options, workers, work, patches);
  const int square = options.patches.size_px * options.patches.size_px;
  const auto too_few = [&](const Patch& patch) {
    const auto usable = static_cast<int>(patch.levels.front().pixels.size());
    return usable < options.patches.min_valid_px || usable < options.patches.min_valid_fraction * square;
  };
  std::erase_if(patches, too_few);
  for (Patch& patch : patches) {
    set_deformation(patch, frame.camera, frame.T_world_camera, options.deformation);
  }
  std::erase_if(patches, too_few);  // the deformation may find no plane or no centre
}

std::vector<Patch> refresh_patches(const ReferenceFrame& frame, const tsdf::TsdfVolume& model,
                                   std::span<const TrackedCentre> survivors, const CutOptions& options,
                                   const Workers& workers) {
  PatchWorkspace work;
  std::vector<Patch> patches;
  refresh_patches(frame, model, survivors, options, workers, work, patches);
  return patches;
}

double fused_share(const tsdf::TsdfVolume& model, std::span<const Patch> patches, const ReferenceFrame& frame,
                   const config::DepthConfig& depth) {
  const SE3 T_camera_world = frame.T_world_camera.inverse();
  double sum = 0;
  std::size_t count = 0;
  for (const Patch& patch : patches) {
    for (const PatchPixel& pixel : patch.levels.front().pixels) {
      ++count;
      const Vector3d point_camera = T_camera_world * pixel.point_world;
      if (!(point_camera.z() > 0) || !is_measured(frame, point_camera)) continue;
      const auto place = model.nearest_voxel(pixel.point_world);
      if (!place) continue;
      const float weight_there = model.voxel(place->slot, place->offset).weight;
      if (!(weight_there > 0)) continue;
      const double weight = model.measurement_weight(point_camera.z(), depth);
      sum += std::min(1.0, weight / static_cast<double>(weight_there));
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace fusebench::patches
