#include "datasets/simulator/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/error.hpp"
#include "core/simd/lane_points.hpp"
#include "datasets/simulator/rays/ray_caster.hpp"
#include "datasets/simulator/render/surface_shading.hpp"
#include "datasets/simulator/render/triangle_planes.hpp"

namespace fusebench::simulator::render {

using simd::Float8;
using simd::Int8;
using simd::kLanes;

namespace {

constexpr std::size_t kRowsPerChunk = 8;
constexpr unsigned kAllLanes = 0xFF;

/// fill(row) for all rows.
template <class Fill>
void for_rows(const Workers& workers, int height, const Fill& fill) {
  workers.for_chunks(static_cast<std::size_t>(height), kRowsPerChunk,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t row = begin; row < end; ++row) fill(static_cast<int>(row));
                     });
}

void check_arguments(const PinholeCamera& camera, const RowPoses& poses) {
  check(camera.width_px > 0 && camera.height_px > 0, "a rendered camera has a size");
  check(poses.T_world_camera.size() == 1 ||
            poses.T_world_camera.size() == static_cast<std::size_t>(camera.height_px),
        "one pose, or one for each row");
}

/// The first `count` of eight lanes.
unsigned first_lanes(std::size_t count) { return count >= kLanes ? kAllLanes : (1U << count) - 1; }

std::size_t whole_packets(std::size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// Directions of a row of pixels on the plane z = 1 of the camera, filled up to whole packets.
struct CameraRow {
  std::vector<float> x;
  std::vector<float> y;

  CameraRow(const rays::RayField& field, int row, const Vector2d& offset_px) {
    const auto width = static_cast<std::size_t>(field.camera().width_px);
    x.resize(whole_packets(width));
    y.resize(x.size());
    field.row(row, offset_px, std::span(x).first(width), std::span(y).first(width));
    std::fill(x.begin() + static_cast<std::ptrdiff_t>(width), x.end(), x[width - 1]);
    std::fill(y.begin() + static_cast<std::ptrdiff_t>(width), y.end(), y[width - 1]);
  }
  [[nodiscard]] simd::Points packet(std::size_t begin) const {
    return {simd::load(&x[begin]), simd::load(&y[begin]), simd::all_lanes(1.0F)};
  }
};

/// Where a camera is, in single precision.
struct CameraPose {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;

  explicit CameraPose(const SE3& T) : R(T.rotation_matrix().cast<float>()), t(T.translation.cast<float>()) {}

  /// Rays of the camera; distances along them are z-depths.
  [[nodiscard]] RayPacket rays(const simd::Points& directions_camera) const {
    return {{simd::all_lanes(t.x()), simd::all_lanes(t.y()), simd::all_lanes(t.z())},
            simd::rotated(R, directions_camera)};
  }
};

/// Rays that are traced together, filled up to whole packets by copies of the last one.
class RayList {
 public:
  void add(const RayPacket& packet) {
    const std::size_t begin = values_[0].size();
    for (auto& values : values_) values.resize(begin + kLanes);
    const std::array<Float8, 6> lanes = {packet.origins.x,    packet.origins.y,    packet.origins.z,
                                         packet.directions.x, packet.directions.y, packet.directions.z};
    for (std::size_t k = 0; k < lanes.size(); ++k) simd::store(lanes[k], &values_[k][begin]);
  }
  void add(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    for (std::size_t k = 0; k < 3; ++k) {
      values_[k].push_back(origin[static_cast<Eigen::Index>(k)]);
      values_[k + 3].push_back(direction[static_cast<Eigen::Index>(k)]);
    }
  }
  void fill_up() {
    for (auto& values : values_) {
      if (!values.empty()) values.resize(whole_packets(values.size()), values.back());
    }
  }
  [[nodiscard]] std::size_t size() const { return values_[0].size(); }
  [[nodiscard]] RayPacket packet(std::size_t begin) const {
    const auto at = [&](std::size_t k) { return simd::load(&values_[k][begin]); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
  }
  [[nodiscard]] rays::RayCaster::Rays rays() const {
    return {{values_[0], values_[1], values_[2]}, {values_[3], values_[4], values_[5]}};
  }

 private:
  std::array<std::vector<float>, 6> values_;  // origin, direction
};

RayList rays_of_row(const rays::RayField& field, int row, const Vector2d& offset_px,
                    const SE3& T_world_camera) {
  const CameraRow camera(field, row, offset_px);
  const CameraPose pose(T_world_camera);
  RayList list;
  for (std::size_t begin = 0; begin < camera.x.size(); begin += kLanes)
    list.add(pose.rays(camera.packet(begin)));
  return list;
}

/// Eight pixels of a row from column `begin` on; those beyond its end are of the next row, or 0.
template <class Lanes, class Pixel>
Lanes load_row(const Image<Pixel>& image, int row, std::size_t begin) {
  Lanes lanes{};
  const std::size_t at = image.index(0, row) + begin;
  std::memcpy(&lanes, &image.data[at], std::min(kLanes, image.data.size() - at) * sizeof(Pixel));
  return lanes;
}

}  // namespace

struct Renderer::State {
  rays::RayCaster caster;
  TrianglePlanes planes;
  SurfaceShading shading;

  explicit State(const scene::SimulatedScene& scene)
      : caster(scene.mesh), planes(scene.mesh, scene.triangle_textures), shading(scene) {}

  /// Where rays meet triangles that they are known to hit (-1: nothing).
  [[nodiscard]] PacketHits meet(Int8 triangles, const RayPacket& rays) const {
    PacketHits hits;
    for_each_value(triangles, simd::lane_bits(triangles >= 0), [&](std::int32_t triangle, Int8 same) {
      const PacketHits on_plane = planes.meet(triangle, rays);
      hits.take(same & (on_plane.distance > 0.0F), on_plane);
    });
    hits.u = simd::clamp(hits.u, 0, 1);
    hits.v = simd::min(simd::clamp(hits.v, 0, 1), 1.0F - hits.u);
    return hits;
  }

  /// The nearest hits, by packet.
  [[nodiscard]] std::vector<PacketHits> trace(const RayList& rays) const {
    std::vector<std::uint32_t> triangles(rays.size());
    caster.nearest_triangles(rays.rays(), triangles);
    std::vector<PacketHits> hits;
    hits.reserve(rays.size() / kLanes);
    for (std::size_t i = 0; i < rays.size(); i += kLanes) {
      Int8 packet;
      std::memcpy(&packet, &triangles[i], sizeof(packet));  // kNothing is -1
      hits.push_back(meet(packet, rays.packet(i)));
    }
    return hits;
  }

  /// Of hits in the given lanes; see SurfaceShading::light_of().
  [[nodiscard]] texture::Texture::Samples light_of(const PacketHits& hits, const RayPacket& rays,
                                                   unsigned lanes, Float8 footprint, Int8 page) const {
    texture::Texture::Samples light = shading.light_of(hits, lanes, footprint, page);
    if (!shading.has_gloss()) return light;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      const std::int32_t triangle = hits.triangle[lane];
      const float gloss = shading.gloss_of(triangle);
      if (gloss <= 0) continue;
      const Eigen::Vector3f ray = rays.direction(lane);
      const Eigen::Vector3f point = rays.origin(lane) + hits.distance[lane] * ray;
      const Eigen::Vector3f& normal = planes.normal(static_cast<std::size_t>(triangle));
      light[lane] += shading.mirrored_light(gloss, normal, point, ray);
    }
    return light;
  }
};

/// The samples of a row. Rays near which other rays met a triangle are tried with that one; the rest are
/// traced at the end, those of a pixel together.
class Renderer::RowLight {
 public:
  RowLight(const State& scene, const rays::RayField& field, std::span<const RowSample> samples,
           std::span<Eigen::Array4f> light)
      : scene_(scene), field_(field), samples_(samples), light_(light) {}

  void add() {
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const RowSample& sample = samples_[s];
      const CameraRow rays(field_, sample.row, sample.offset_px);
      if (sample.nearby == nullptr || sample.foreground != nullptr) {
        for (std::size_t i = 0; i < light_.size(); ++i) leave(s, rays, i);
      } else {
        add_nearby(s, rays);
      }
    }
    if (!left_.empty()) add_left();
  }

 private:
  /// A ray that is still to be traced.
  struct Left {
    std::uint32_t pixel;  ///< column
    std::uint32_t sample;
    Eigen::Vector3f direction_camera;
  };
  void leave(std::size_t sample, const CameraRow& rays, std::size_t i) {
    left_.push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(sample), {rays.x[i], rays.y[i], 1.0F}});
  }

  void add_nearby(std::size_t s, const CameraRow& rays) {
    const RowSample& sample = samples_[s];
    const CameraPose pose(sample.T_world_camera);
    const CameraPose to_nearby(sample.nearby->poses.of_row(sample.row).inverse() * sample.T_world_camera);
    const CameraRow middles(field_, sample.row, Vector2d::Zero());
    const Int8 page = simd::all_lanes(scene_.shading.page_at(sample.time_s));
    const Float8 footprint = simd::all_lanes(sample.footprint_px / static_cast<float>(field_.camera().fx_px));
    for (std::size_t begin = 0; begin < light_.size(); begin += kLanes) {
      const unsigned wanted = wanted_lanes(sample, begin);
      if (wanted == 0) continue;
      unsigned found = 0;
      if (sample.pixels != Pixels::at_edges) {
        const RayPacket world = pose.rays(rays.packet(begin));
        const PacketHits hits = try_nearby(sample, to_nearby, rays, middles, world, begin);
        found = wanted & simd::lane_bits(hits.triangle >= 0);
        const texture::Texture::Samples light = scene_.light_of(hits, world, found, footprint, page);
        for (unsigned lanes = found; lanes != 0; lanes &= lanes - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
          light_[begin + lane] += sample.weight * light[lane];
        }
      }
      for (unsigned lanes = wanted & ~found; lanes != 0; lanes &= lanes - 1)
        leave(s, rays, begin + static_cast<std::size_t>(std::countr_zero(lanes)));
    }
  }

  [[nodiscard]] unsigned wanted_lanes(const RowSample& sample, std::size_t begin) const {
    const unsigned there = first_lanes(light_.size() - begin);
    if (sample.pixels == Pixels::all) return there;
    const Int8 face = load_row<Int8>(sample.nearby->face, sample.row, begin);
    const unsigned at_edge = simd::lane_bits(face == VisibleTriangles::kEdge);
    return there & (sample.pixels == Pixels::at_edges ? at_edge : ~at_edge);
  }

  /// Hits of rays that land inside a face, on triangles of that face that one of the eight landed on. A
  /// nearer surface would be where the ray lands by the depth of the nearest one around.
  [[nodiscard]] PacketHits try_nearby(const RowSample& sample, const CameraPose& to_nearby,
                                      const CameraRow& rays, const CameraRow& middles, const RayPacket& world,
                                      std::size_t begin) const {
    const VisibleTriangles& nearby = *sample.nearby;
    const simd::Points directions = simd::rotated(to_nearby.R, rays.packet(begin));
    const auto landing = [&](const Image<float>& inverse_depth) {
      return pixel_of(sample, to_nearby.t, directions, load_row<Float8>(inverse_depth, sample.row, begin),
                      middles.packet(begin), begin);
    };
    const Int8 at = landing(nearby.inverse_depth_per_m);
    const Int8 face = simd::gather(nearby.face.data.data(), at);
    const Int8 face_before =
        simd::gather(nearby.face.data.data(), landing(nearby.nearest_inverse_depth_per_m));
    const Int8 triangle = simd::gather(nearby.triangle.data.data(), at);
    const Int8 usable = (face != VisibleTriangles::kEdge) & (face == face_before);
    PacketHits hits;
    for_each_value(triangle, simd::lane_bits(usable), [&](std::int32_t candidate, Int8) {
      const PacketHits on_plane = scene_.planes.meet(candidate, world);
      const Int8 same_face = face == scene_.planes.faces()[candidate];
      hits.take(usable & same_face & TrianglePlanes::inside(on_plane), on_plane);
    });
    return hits;
  }

  /// Index of the pixel nearby that looks at the point of a ray with this inverse depth. directions: in the
  /// frame of the camera nearby, to which t_nearby moves the ray's camera.
  [[nodiscard]] Int8 pixel_of(const RowSample& sample, const Eigen::Vector3f& t_nearby,
                              const simd::Points& directions, Float8 inverse_depth,
                              const simd::Points& middles, std::size_t begin) const {
    const PinholeCamera& camera = field_.camera();
    const simd::Points moved{simd::multiply_add(t_nearby.x(), inverse_depth, directions.x),
                             simd::multiply_add(t_nearby.y(), inverse_depth, directions.y),
                             simd::multiply_add(t_nearby.z(), inverse_depth, directions.z)};
    // Distortion is nearly constant over such steps.
    const Float8 du = static_cast<float>(camera.fx_px) * (moved.x / moved.z - middles.x);
    const Float8 dv = static_cast<float>(camera.fy_px) * (moved.y / moved.z - middles.y);
    const Float8 u = du + simd::kLaneNumber + (static_cast<float>(begin) + 0.5F);
    const Float8 v = dv + (static_cast<float>(sample.row) + 0.5F);
    const Int8 column = simd::to_int(simd::clamp(u, 0, static_cast<float>(camera.width_px - 1)));
    const Int8 row = simd::to_int(simd::clamp(v, 0, static_cast<float>(camera.height_px - 1)));
    return row * camera.width_px + column;
  }

  /// Traces the rays that are left, in the order of their pixels.
  void add_left() {
    std::ranges::stable_sort(left_, {}, &Left::pixel);
    std::vector<CameraPose> poses, poses_before;
    bool anything_before = false;
    for (const RowSample& sample : samples_) {
      poses.emplace_back(sample.T_world_camera);
      const Foreground* before = sample.foreground;
      poses_before.emplace_back(before != nullptr ? before->T_object_camera : SE3{});
      anything_before |= before != nullptr;
    }
    const RayList rays = rays_left(poses);
    const std::vector<PacketHits> hits = scene_.trace(rays);
    if (!anything_before) {
      for (std::size_t i = 0; i < hits.size(); ++i)
        shade_left(scene_, hits[i], rays.packet(i * kLanes), i * kLanes, hits[i].triangle >= 0);
      return;
    }
    // All samples have a foreground, and the same thing in it.
    const State& thing = *samples_.front().foreground->thing.state_;
    const RayList rays_before = rays_left(poses_before);
    const std::vector<PacketHits> hits_before = thing.trace(rays_before);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const std::size_t begin = i * kLanes;
      const PacketHits& far = hits[i];
      const PacketHits& near = hits_before[i];
      const Int8 hidden = (near.triangle >= 0) & ((far.triangle < 0) | (near.distance < far.distance));
      shade_left(thing, near, rays_before.packet(begin), begin, hidden);
      shade_left(scene_, far, rays.packet(begin), begin, ~hidden & (far.triangle >= 0));
    }
  }

  [[nodiscard]] RayList rays_left(const std::vector<CameraPose>& poses) const {
    RayList list;
    for (const Left& ray : left_) list.add(poses[ray.sample].t, poses[ray.sample].R * ray.direction_camera);
    list.fill_up();
    return list;
  }

  void shade_left(const State& seen, const PacketHits& hits, const RayPacket& rays, std::size_t begin,
                  Int8 which) const {
    const unsigned lanes = first_lanes(left_.size() - begin) & simd::lane_bits(which);
    if (lanes == 0) return;
    Float8 footprint{};
    Int8 page{};
    for (std::size_t lane = 0; lane < std::min(kLanes, left_.size() - begin); ++lane) {
      const RowSample& sample = samples_[left_[begin + lane].sample];
      footprint[lane] = sample.footprint_px / static_cast<float>(field_.camera().fx_px);
      page[lane] = seen.shading.page_at(sample.time_s);
    }
    const texture::Texture::Samples light = seen.light_of(hits, rays, lanes, footprint, page);
    for (unsigned bits = lanes; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      const Left& ray = left_[begin + lane];
      light_[ray.pixel] += samples_[ray.sample].weight * light[lane];
    }
  }

  const State& scene_;
  const rays::RayField& field_;
  std::span<const RowSample> samples_;
  std::span<Eigen::Array4f> light_;
  std::vector<Left> left_;
};

Renderer::Renderer(const scene::SimulatedScene& scene) : state_(std::make_unique<State>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::add_light_of_row(const rays::RayField& rays, std::span<const RowSample> samples,
                                std::span<Eigen::Array4f> light) const {
  for (const RowSample& sample : samples)
    check(sample.pixels == Pixels::all || sample.nearby != nullptr, "edges are known of what is seen nearby");
  RowLight(*state_, rays, samples, light).add();
}

void Renderer::render_light(const PinholeCamera& camera, const RowPoses& poses, const Vector2d& offset_px,
                            const Workers& workers, Image<Eigen::Vector3f>& light) const {
  check_arguments(camera, poses);
  const rays::RayField rays(camera);
  light = Image<Eigen::Vector3f>(camera.width_px, camera.height_px, Eigen::Vector3f::Zero());
  for_rows(workers, camera.height_px, [&](int row) {
    std::vector<Eigen::Array4f> pixels(static_cast<std::size_t>(camera.width_px), Eigen::Array4f::Zero());
    const RowSample sample{.row = row, .T_world_camera = poses.of_row(row), .offset_px = offset_px};
    add_light_of_row(rays, {&sample, 1}, pixels);
    for (int u = 0; u < camera.width_px; ++u)
      light(u, row) = pixels[static_cast<std::size_t>(u)].head<3>().matrix();
  });
}

VisibleTriangles Renderer::visible_triangles(const rays::RayField& rays, RowPoses poses,
                                             const Workers& workers) const {
  const PinholeCamera& camera = rays.camera();
  check_arguments(camera, poses);
  VisibleTriangles visible;
  visible.poses = std::move(poses);
  visible.triangle = Image<std::int32_t>(camera.width_px, camera.height_px);
  visible.inverse_depth_per_m = Image<float>(camera.width_px, camera.height_px);
  for_rows(workers, camera.height_px, [&](int row) {
    const std::vector<PacketHits> hits =
        state_->trace(rays_of_row(rays, row, Vector2d::Zero(), visible.poses.of_row(row)));
    for (int u = 0; u < camera.width_px; ++u) {
      const PacketHits& packet = hits[static_cast<std::size_t>(u) / kLanes];
      const std::size_t lane = static_cast<std::size_t>(u) % kLanes;
      visible.triangle(u, row) = packet.triangle[lane];
      visible.inverse_depth_per_m(u, row) = packet.triangle[lane] < 0 ? 0.0F : 1.0F / packet.distance[lane];
    }
  });
  mark_edges(state_->planes.faces(), visible);
  return visible;
}

void Renderer::render_surfaces(const PinholeCamera& camera, const RowPoses& poses, const Workers& workers,
                               Image<Surface>& surfaces, bool material) const {
  check_arguments(camera, poses);
  const rays::RayField rays(camera);
  surfaces = Image<Surface>(camera.width_px, camera.height_px);
  const Float8 footprint = simd::all_lanes(1.0F / static_cast<float>(camera.fx_px));
  for_rows(workers, camera.height_px, [&](int row) {
    const std::vector<PacketHits> hits =
        state_->trace(rays_of_row(rays, row, Vector2d::Zero(), poses.of_row(row)));
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const std::size_t begin = i * kLanes;
      const PacketHits& packet = hits[i];
      const unsigned seen = simd::lane_bits(packet.triangle >= 0) &
                            first_lanes(static_cast<std::size_t>(camera.width_px) - begin);
      texture::Texture::Samples reflectance;
      if (material) reflectance = state_->shading.light_of(packet, seen, footprint, Int8{}, false);
      for (unsigned left = seen; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        Surface& surface = surfaces(static_cast<int>(begin + lane), row);
        const std::int32_t triangle = packet.triangle[lane];
        surface = {packet.distance[lane], packet.cos_incidence[lane], static_cast<std::uint32_t>(triangle)};
        if (!material) continue;
        surface.reflectance = reflectance[lane].head<3>().sum() / 3;
        surface.gloss = state_->shading.gloss_of(triangle);
      }
    }
  });
}

}  // namespace fusebench::simulator::render
