#include "datasets/simulator/rays/ray_caster.hpp"

#include <embree3/rtcore.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::simulator::rays {

namespace {

constexpr std::size_t kLanes = 8;
using Lanes = Eigen::Array<float, kLanes, 1>;

/// The instruction set is fixed, since it affects which rays hit an edge. "threads" is not set: Embree would
/// limit oneTBB for the whole program during the life of the device.
constexpr const char* kDeviceConfiguration = "isa=avx2,start_threads=0,set_affinity=0";

struct Triangle {
  Eigen::Vector3d corner, to_second, to_third;
  double twice_area;
};

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& indices : mesh.triangles) {
    const auto vertex = [&](std::size_t k) { return mesh.vertices[indices[k]].cast<double>().eval(); };
    const Eigen::Vector3d to_second = vertex(1) - vertex(0), to_third = vertex(2) - vertex(0);
    triangles.push_back({vertex(0), to_second, to_third, to_second.cross(to_third).norm()});
  }
  return triangles;
}

/// Intersection with the plane of a triangle that Embree reported as hit (Moeller and Trumbore 1997).
/// Embree's own values use approximate reciprocals, whose last bits differ between CPU vendors.
RayHit hit_on(const Triangle& triangle, std::uint32_t index, const Eigen::Vector3d& origin,
              const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = direction.cross(triangle.to_third);
  const double volume = triangle.to_second.dot(across);
  if (volume == 0) return {};  // the ray is in the plane
  const Eigen::Vector3d from_corner = origin - triangle.corner;
  const Eigen::Vector3d lift = from_corner.cross(triangle.to_second);
  const double u = std::clamp(from_corner.dot(across) / volume, 0.0, 1.0);
  const double v = std::clamp(direction.dot(lift) / volume, 0.0, 1 - u);
  const double cosine = std::abs(volume) / (direction.norm() * triangle.twice_area);
  return {static_cast<float>(triangle.to_third.dot(lift) / volume), static_cast<float>(u),
          static_cast<float>(v), static_cast<float>(std::min(1.0, cosine)), index};
}

}  // namespace

struct RayCaster::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Triangle> triangles;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

/// Reports an Embree failure, stored in the device (nullptr: in the thread). Insufficient memory is not a
/// bug.
void check_embree(RTCDevice device, bool worked, const char* claim) {
  RTCError error = rtcGetDeviceError(device);
  // The query itself allocates memory. If that fails, it returns "unknown", and the next query returns the
  // reason.
  if (error == RTC_ERROR_UNKNOWN) error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  check(worked && error == RTC_ERROR_NONE, claim);
}

}  // namespace

RayCaster::RayCaster(const Mesh& mesh) : state_(std::make_unique<State>()) {
  state_->triangles = triangles_of(mesh);
  state_->device = rtcNewDevice(kDeviceConfiguration);
  check_embree(state_->device, state_->device != nullptr,
               "Embree needs a CPU with AVX2, as this program does");
  state_->scene = rtcNewScene(state_->device);
  check_embree(state_->device, state_->scene != nullptr, "Embree made a scene");
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);  // no gaps between neighbouring triangles
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_MEDIUM);
  const RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  check_embree(state_->device, geometry != nullptr, "Embree made a geometry");
  const auto fill = [&](RTCBufferType type, RTCFormat format, const auto& items) {
    constexpr std::size_t size = sizeof(items[0]);
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, size, items.size());
    if (buffer != nullptr && !items.empty()) std::memcpy(buffer, items.data(), size * items.size());
  };
  fill(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
  fill(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(state_->scene, geometry, 0);
  rtcReleaseGeometry(geometry);
  check_embree(state_->device, true, "Embree took the geometry");
  {
    // The order of triangles within a leaf determines which of two triangles with a common edge is hit. It
    // must not depend on the number of threads.
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    rtcCommitScene(state_->scene);
  }
  check_embree(state_->device, true, "Embree took the triangles");
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

namespace {

/// Traces `count` rays in packets of eight. fill(packet, lane, index of the ray) sets origin and direction;
/// visit(index of the ray, index of its triangle or RayHit::kNothing).
template <class Fill, class Visit>
void trace(RTCScene scene, std::size_t count, const Fill& fill, const Visit& visit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const auto lanes = [](float* values) { return Eigen::Map<Lanes, Eigen::Aligned32>(values); };
  RTCRayHit8 packet;
  lanes(packet.ray.tnear) = 0;
  lanes(packet.ray.time) = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
  }
  alignas(32) std::array<int, kLanes> valid{};
  for (std::size_t begin = 0; begin < count; begin += kLanes) {
    const std::size_t used = std::min(kLanes, count - begin);
    for (std::size_t i = 0; i < kLanes; ++i) {
      valid[i] = i < used ? -1 : 0;
      fill(packet, i, begin + std::min(i, used - 1));
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    lanes(packet.ray.tfar) = std::numeric_limits<float>::infinity();
    rtcIntersect8(valid.data(), scene, &context, &packet);
    for (std::size_t i = 0; i < used; ++i) {
      const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      visit(begin + i, hit ? packet.hit.primID[i] : RayHit::kNothing);
    }
  }
}

void set_ray(RTCRayHit8& packet, std::size_t lane, const Eigen::Vector3f& origin,
             const Eigen::Vector3f& direction) {
  packet.ray.org_x[lane] = origin.x();
  packet.ray.org_y[lane] = origin.y();
  packet.ray.org_z[lane] = origin.z();
  packet.ray.dir_x[lane] = direction.x();
  packet.ray.dir_y[lane] = direction.y();
  packet.ray.dir_z[lane] = direction.z();
}

}  // namespace

void RayCaster::cast(const Eigen::Vector3f& origin, std::span<const float> x, std::span<const float> y,
                     std::span<const float> z, std::span<RayHit> hits) const {
  trace(
      state_->scene, hits.size(),
      [&](RTCRayHit8& packet, std::size_t lane, std::size_t i) {
        set_ray(packet, lane, origin, {x[i], y[i], z[i]});
      },
      [&](std::size_t i, std::uint32_t triangle) {
        hits[i] = triangle == RayHit::kNothing
                      ? RayHit{}
                      : hit_on(state_->triangles[triangle], triangle, origin.cast<double>(),
                               Eigen::Vector3f(x[i], y[i], z[i]).cast<double>());
      });
}

void RayCaster::nearest_triangles(const Rays& rays, std::span<std::uint32_t> triangles) const {
  trace(
      state_->scene, triangles.size(),
      [&](RTCRayHit8& packet, std::size_t lane, std::size_t i) {
        set_ray(packet, lane, {rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]},
                {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]});
      },
      [&](std::size_t i, std::uint32_t triangle) { triangles[i] = triangle; });
}

bool RayCaster::blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = 1.0F;
  ray.mask = ~0U;
  rtcOccluded1(state_->scene, &context, &ray);
  return ray.tfar < 0.0F;  // Embree's sign for an occluded ray
}

}  // namespace fusebench::simulator::rays
