#include "datasets/simulator/render/row_light.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/simd/lane_points.hpp"

namespace fusebench::simulator::render {

using simd::Float8;
using simd::Int8;
using simd::kLanes;

namespace {

/// Eight pixels of a row from column `begin` on; lanes beyond its end have arbitrary values.
Float8 load_row(const Image<float>& image, int row, std::size_t begin) {
  Float8 lanes{};
  const std::size_t at = image.index(0, row) + begin;
  std::memcpy(&lanes, &image.data[at], std::min(kLanes, image.data.size() - at) * sizeof(float));
  return lanes;
}

/// Accumulates the samples of a row. A ray is first tested against the triangle of a nearby hit; the others
/// are traced at the end, grouped by pixel.
class RowLight {
 public:
  RowLight(const LitScene& scene, const rays::RayField& field, std::span<const RowSample> samples,
           std::span<Eigen::Array4f> light)
      : scene_(scene), field_(field), samples_(samples), light_(light) {}

  void add() {
    if (samples_.empty()) return;
    const CameraRow middles(field_, samples_.front().row, Vector2d::Zero());
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const RowSample& sample = samples_[s];
      const CameraRow rays(field_, sample.row, sample.offset_px);
      if (sample.nearby == nullptr || sample.foreground != nullptr) {
        for (std::size_t i = 0; i < light_.size(); ++i) leave(s, rays, i);
      } else {
        add_nearby(s, rays, middles);
      }
    }
    if (!left_.empty()) add_left();
  }

 private:
  /// A ray to be traced.
  struct Left {
    std::uint32_t pixel;  ///< column
    std::uint32_t sample;
    Eigen::Vector3f direction_camera;
  };
  void leave(std::size_t sample, const CameraRow& rays, std::size_t i) {
    left_.push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(sample), {rays.x[i], rays.y[i], 1.0F}});
  }

  void add_nearby(std::size_t s, const CameraRow& rays, const CameraRow& middles) {
    const RowSample& sample = samples_[s];
    const CameraPose pose(sample.T_world_camera);
    const CameraPose to_nearby(sample.nearby->poses.of_row(sample.row).inverse() * sample.T_world_camera);
    const Int8 page = simd::all_lanes(scene_.shading.page_at(sample.time_s));
    const Float8 footprint = simd::all_lanes(sample.footprint_px / static_cast<float>(field_.camera().fx_px));
    for (std::size_t begin = 0; begin < light_.size(); begin += kLanes) {
      const unsigned wanted = first_lanes(light_.size() - begin);
      const RayPacket world = pose.rays(rays.packet(begin));
      const PacketHits hits = try_nearby(sample, to_nearby, rays, middles, world, begin);
      const unsigned found = wanted & simd::lane_bits(hits.triangle >= 0);
      const texture::Texture::Samples light = scene_.light_of(hits, world, found, footprint, page);
      for (unsigned lanes = found; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        light_[begin + lane] += sample.weight * light[lane];
      }
      for (unsigned lanes = wanted & ~found; lanes != 0; lanes &= lanes - 1)
        leave(s, rays, begin + static_cast<std::size_t>(std::countr_zero(lanes)));
    }
  }

  /// Tests rays that project into the interior of a face against the triangles of that face nearby. A nearer
  /// surface would project there at the depth of the nearest surface around.
  [[nodiscard]] PacketHits try_nearby(const RowSample& sample, const CameraPose& to_nearby,
                                      const CameraRow& rays, const CameraRow& middles, const RayPacket& world,
                                      std::size_t begin) const {
    const VisibleTriangles& nearby = *sample.nearby;
    const simd::Points directions = simd::rotated(to_nearby.R, rays.packet(begin));
    const auto landing = [&](const Image<float>& inverse_depth) {
      return pixel_of(sample, to_nearby.t, directions, load_row(inverse_depth, sample.row, begin),
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

  /// Index of the nearby image's pixel that shows the point of a ray with this inverse depth. directions: in
  /// the frame of the nearby camera; t_nearby: translation to that frame.
  [[nodiscard]] Int8 pixel_of(const RowSample& sample, const Eigen::Vector3f& t_nearby,
                              const simd::Points& directions, Float8 inverse_depth,
                              const simd::Points& middles, std::size_t begin) const {
    const PinholeCamera& camera = field_.camera();
    const simd::Points moved{simd::multiply_add(t_nearby.x(), inverse_depth, directions.x),
                             simd::multiply_add(t_nearby.y(), inverse_depth, directions.y),
                             simd::multiply_add(t_nearby.z(), inverse_depth, directions.z)};
    // Distortion is nearly constant over such distances.
    const Float8 du = static_cast<float>(camera.fx_px) * (moved.x / moved.z - middles.x);
    const Float8 dv = static_cast<float>(camera.fy_px) * (moved.y / moved.z - middles.y);
    const Float8 u = du + simd::kLaneNumber + (static_cast<float>(begin) + 0.5F);
    const Float8 v = dv + (static_cast<float>(sample.row) + 0.5F);
    const Int8 column = simd::to_int(simd::clamp(u, 0, static_cast<float>(camera.width_px - 1)));
    const Int8 row = simd::to_int(simd::clamp(v, 0, static_cast<float>(camera.height_px - 1)));
    return row * camera.width_px + column;
  }

  /// Traces the remaining rays in the order of their pixels.
  void add_left() {
    sort_by_pixel();
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
    // All samples have the same foreground object.
    const LitScene& thing = samples_.front().foreground->thing.scene();
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

  /// Stable sort by pixel.
  void sort_by_pixel() {
    std::vector<std::uint32_t> next(light_.size() + 1, 0);  // by pixel: index of its next ray
    for (const Left& ray : left_) ++next[ray.pixel + 1];
    for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
    std::vector<Left> sorted(left_.size());
    for (const Left& ray : left_) sorted[next[ray.pixel]++] = ray;
    left_ = std::move(sorted);
  }

  [[nodiscard]] RayList rays_left(const std::vector<CameraPose>& poses) const {
    RayList list(left_.size());
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const CameraPose& pose = poses[left_[i].sample];
      list.set(i, pose.t, pose.R * left_[i].direction_camera);
    }
    list.repeat_from(left_.size());
    return list;
  }

  void shade_left(const LitScene& seen, const PacketHits& hits, const RayPacket& rays, std::size_t begin,
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

  const LitScene& scene_;
  const rays::RayField& field_;
  std::span<const RowSample> samples_;
  std::span<Eigen::Array4f> light_;
  std::vector<Left> left_;
};

}  // namespace

void add_light_of_samples(const LitScene& scene, const rays::RayField& field,
                          std::span<const RowSample> samples, std::span<Eigen::Array4f> light) {
  RowLight(scene, field, samples, light).add();
}

}  // namespace fusebench::simulator::render
