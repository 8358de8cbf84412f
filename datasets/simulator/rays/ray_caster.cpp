#include "datasets/simulator/rays/ray_caster.hpp"

#include <embree3/rtcore.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <cstring>

#include "core/base/error.hpp"

namespace fusebench::simulator::rays {

namespace {

constexpr std::size_t kLanes = 8;
using Lanes = Eigen::Array<float, kLanes, 1>;

/// The instruction set affects the last bits, so it is fixed rather than taken from the machine. "threads" is
/// not set: Embree would limit oneTBB for the whole program for as long as the device lives.
constexpr const char* kDeviceConfiguration = "isa=avx2,start_threads=0,set_affinity=0";

}  // namespace

struct RayCaster::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const Mesh& mesh) : state_(std::make_unique<State>()) {
  state_->device = rtcNewDevice(kDeviceConfiguration);
  check(state_->device != nullptr, "Embree needs a CPU with AVX2, as this program does");
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);  // no light leaks between neighbouring triangles
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_MEDIUM);
  const RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto fill = [&](RTCBufferType type, RTCFormat format, const auto& items) {
    constexpr std::size_t size = sizeof(items[0]);
    void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, size, items.size());
    if (!items.empty()) std::memcpy(buffer, items.data(), size * items.size());
  };
  fill(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
  fill(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(state_->scene, geometry, 0);
  rtcReleaseGeometry(geometry);
  {
    // The order of the triangles within a leaf, and with it which of two that share an edge is hit, must not
    // depend on the number of threads.
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    rtcCommitScene(state_->scene);
  }
  check(rtcGetDeviceError(state_->device) == RTC_ERROR_NONE, "Embree took the triangles");
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

void RayCaster::cast(const Eigen::Vector3f& origin, std::span<const float> x, std::span<const float> y,
                     std::span<const float> z, std::span<RayHit> hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const auto lanes = [](float* values) { return Eigen::Map<Lanes, Eigen::Aligned32>(values); };
  RTCRayHit8 packet;
  lanes(packet.ray.org_x) = origin.x();
  lanes(packet.ray.org_y) = origin.y();
  lanes(packet.ray.org_z) = origin.z();
  lanes(packet.ray.tnear) = 0;
  lanes(packet.ray.time) = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
  }
  alignas(32) std::array<int, kLanes> valid{};
  for (std::size_t begin = 0; begin < hits.size(); begin += kLanes) {
    const std::size_t count = std::min(kLanes, hits.size() - begin);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t from = begin + std::min(i, count - 1);
      valid[i] = i < count ? -1 : 0;
      packet.ray.dir_x[i] = x[from];
      packet.ray.dir_y[i] = y[from];
      packet.ray.dir_z[i] = z[from];
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    lanes(packet.ray.tfar) = std::numeric_limits<float>::infinity();
    rtcIntersect8(valid.data(), state_->scene, &context, &packet);
    const auto dx = lanes(packet.ray.dir_x), dy = lanes(packet.ray.dir_y), dz = lanes(packet.ray.dir_z);
    const auto nx = lanes(packet.hit.Ng_x), ny = lanes(packet.hit.Ng_y), nz = lanes(packet.hit.Ng_z);
    const Lanes squares = (dx * dx + dy * dy + dz * dz) * (nx * nx + ny * ny + nz * nz);
    const Lanes cosine = (dx * nx + dy * ny + dz * nz).abs() / squares.sqrt();
    for (std::size_t i = 0; i < count; ++i) {
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
        hits[begin + i] = {};
      } else {
        hits[begin + i] = {packet.ray.tfar[i], packet.hit.u[i], packet.hit.v[i],
                           std::min(1.0F, cosine[static_cast<Eigen::Index>(i)]), packet.hit.primID[i]};
      }
    }
  }
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
