// The preset that moves sideways before a rack full of small things, and the room in which it does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/scene/storage_room.hpp"
#include "datasets/simulator/simulation.hpp"

namespace fusebench {

using namespace synthetic_imu;
using namespace simulator::scene;
using namespace simulator::render;
using namespace simulator::motion;
using namespace simulator::layouts;
using namespace simulator;

namespace {

constexpr std::int64_t kFrame_ns = 33'333'333;
// Colour of the ZR300 layout, which sees more to the sides than its depth camera.
constexpr PinholeCamera kCamera = {160, 120, 152, 152, 79.5, 59.5};

const SimulatedScene& storage_room(std::uint64_t seed) {
  static std::map<std::uint64_t, SimulatedScene> rooms;
  auto found = rooms.find(seed);
  if (found == rooms.end()) found = rooms.emplace(seed, make_storage_room(seed)).first;
  return found->second;
}

MotionSpan span_of(double duration_s) {
  return {5'000'000, 755'000'000, 755'000'000 + std::llround(1e9 * duration_s)};
}

Result<PoseSpline> sweep(std::uint64_t seed, bool from_rest, const MotionSpan& span) {
  const SimulatedScene& room = storage_room(seed);
  HeadingTexture texture;
  texture.only_rad = room.heading_rad;
  MotionOptions options = motion_preset(MotionPreset::sweep);
  options.from_rest = from_rest;
  return hand_held_motion(options, span, room.free_space, seed, texture);
}

/// Share of 10 x 10 patches of a VGA image (2.5 x 2.5 pixels here, so 3 x 3) whose pixels, by their depth
/// alone, move by more than 3 VGA pixels relative to each other while the camera moves sideways by 5 cm.
double share_of_deformed_patches(const Image<Renderer::Surface>& surfaces) {
  constexpr double kVga = 4;
  constexpr double kStep_m = 0.05;
  int deformed = 0;
  int count = 0;
  for (int v = 0; v + 3 <= surfaces.height; v += 3) {
    for (int u = 0; u + 3 <= surfaces.width; u += 3) {
      double least_px = 1e9;
      double most_px = 0;
      for (int i = 0; i < 9; ++i) {
        const double depth_m = static_cast<double>(surfaces(u + i % 3, v + i / 3).depth_m);
        const double moved_px = kVga * kCamera.fx_px * kStep_m / depth_m;
        least_px = std::min(least_px, moved_px);
        most_px = std::max(most_px, moved_px);
      }
      ++count;
      if (most_px - least_px > 3) ++deformed;
    }
  }
  return static_cast<double>(deformed) / count;
}

TEST(StorageRoom, IsAFunctionOfTheSeed) {
  const SimulatedScene again = make_storage_room(1);
  EXPECT_EQ(again.mesh.vertices, storage_room(1).mesh.vertices);
  EXPECT_EQ(again.light, storage_room(1).light);
  EXPECT_NE(again.mesh.vertices, storage_room(2).mesh.vertices);
}

TEST(StorageRoom, HasSoundTriangles) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Mesh& mesh = storage_room(seed).mesh;
    EXPECT_LT(mesh.triangles.size(), 1'500'000U);
    for (const auto& t : mesh.triangles) {
      const Vector3d a = mesh.vertices[t[0]].cast<double>();
      const Vector3d area =
          (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
      ASSERT_GT(area.norm(), 1e-10);
      ASSERT_GT(area.normalized().dot(mesh.normals[t[0]].cast<double>()), 0.3);  // seen from outside
    }
  }
}

TEST(StorageRoom, NothingReachesIntoTheSlabOfTheCamera) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SimulatedScene& room = storage_room(seed);
    for (const Eigen::Vector3f& vertex : room.mesh.vertices) {
      const Vector3d point = vertex.cast<double>();
      const bool beside = std::abs(point.y()) < room.free_space.max().y() &&
                          point.z() > room.free_space.min().z() && point.z() < room.free_space.max().z();
      if (!beside || point.x() < 0) continue;
      ASSERT_GT(room.free_space.exteriorDistance(point), 0.7) << point.transpose();
    }
  }
}

TEST(Sweep, MovesAcrossItsDirectionOfViewAndKeepsLookingAtTheRack) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const bool from_rest : {false, true}) {
      const MotionSpan span = span_of(5);
      const auto motion = sweep(seed, from_rest, span);
      ASSERT_TRUE(motion) << motion.error().message;
      double across = 0;
      double along = 0;
      for (std::int64_t t = span.first_frame_ns; t <= span.last_frame_ns; t += 5'000'000) {
        const Kinematics k = motion->evaluate(t);
        const Vector3d velocity_camera = k.T_world_body.rotation.conjugate() * k.velocity_world_mps;
        across += velocity_camera.head<2>().squaredNorm();
        along += velocity_camera.z() * velocity_camera.z();
        const Vector3d forward = k.T_world_body.rotation * Vector3d::UnitZ();
        ASSERT_GT(forward.x(), std::cos(radians(35))) << seed;
        ASSERT_LT(storage_room(seed).free_space.exteriorDistance(k.T_world_body.translation), 1e-9);
      }
      EXPECT_GT(across, 6 * along) << seed;
      const PeakSpeeds peaks = peak_speeds(*motion, SE3{}, span.first_frame_ns, span.last_frame_ns);
      EXPECT_NEAR(peaks.speed_mps, 2.0, 0.02);
      EXPECT_NEAR(peaks.rate_radps, 1.0, 0.01);
    }
  }
}

TEST(Sweep, SeesDeepClutterBeyondTheNearRangeOfTheSensor) {
  constexpr float kNearRange_m = 584.0F * 0.07F / 63;  // focal length, baseline and disparities of the ZR300
  const Workers workers(1);
  const MotionSpan span = span_of(5);
  Image<Renderer::Surface> surfaces;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Renderer renderer(storage_room(seed));
    const auto motion = sweep(seed, false, span);
    ASSERT_TRUE(motion) << motion.error().message;
    std::vector<float> depths;
    std::vector<double> deformed;
    for (std::int64_t t = span.first_frame_ns; t < span.last_frame_ns; t += 5 * kFrame_ns) {
      renderer.render_surfaces(kCamera, {{motion->evaluate(t).T_world_body}}, workers, surfaces);
      for (const Renderer::Surface& surface : surfaces.data) depths.push_back(surface.depth_m);
      deformed.push_back(share_of_deformed_patches(surfaces));
    }
    std::ranges::sort(depths);
    std::ranges::sort(deformed);
    EXPECT_GT(depths.front(), kNearRange_m) << seed;
    EXPECT_LT(depths[depths.size() / 2], 1.25F) << seed;
    EXPECT_GT(deformed[deformed.size() / 2], 0.15) << seed;
  }
}

TEST(Sweep, OtherPresetsAreFarFromDeepClutter) {
  const Workers workers(1);
  const MotionSpan span = span_of(5);
  const SimulatedScene room = make_room(1);
  const Renderer renderer(room);
  const auto motion = hand_held_motion(motion_preset(MotionPreset::fast), span, room.free_space, 1);
  ASSERT_TRUE(motion) << motion.error().message;
  std::vector<double> deformed;
  Image<Renderer::Surface> surfaces;
  for (std::int64_t t = span.first_frame_ns; t < span.last_frame_ns; t += 5 * kFrame_ns) {
    renderer.render_surfaces(kCamera, {{motion->evaluate(t).T_world_body}}, workers, surfaces);
    deformed.push_back(share_of_deformed_patches(surfaces));
  }
  std::ranges::sort(deformed);
  EXPECT_LT(deformed[deformed.size() / 2], 0.08);
}

TEST(Sweep, BringsItsRoomAndSaysSo) {
  for (const MotionPreset preset : {MotionPreset::slow, MotionPreset::fast, MotionPreset::shake}) {
    const SimulationOptions options = simulation_defaults(RecordingLayout::tum, preset).value();
    EXPECT_EQ(options.room, RoomKind::furnished);
    const std::string text = simulation_text(options, "", Vector3d::Zero());
    EXPECT_NE(text.find("kind = \"furnished room of the seed\"\n"), std::string::npos);
    EXPECT_EQ(text.find("sideways"), std::string::npos);
  }
  SimulationOptions options = simulation_defaults(RecordingLayout::tum, MotionPreset::sweep).value();
  EXPECT_EQ(options.room, RoomKind::storage);
  const std::string text = simulation_text(options, "", Vector3d::Zero());
  EXPECT_NE(text.find("kind = \"storage room of the seed\"\n"), std::string::npos);
  EXPECT_NE(text.find("sideways = true\n"), std::string::npos);
  const std::string identity = simulation_identity(options).value();
  options.room = RoomKind::furnished;
  EXPECT_NE(simulation_identity(options).value(), identity);
}

TEST(Sweep, WithoutAHeadingItFollowsTheTextureAlongAnAxis) {
  const MotionSpan span = span_of(4);
  const Eigen::AlignedBox3d box(Vector3d(-1.5, -1.5, 0.9), Vector3d(1.5, 1.5, 1.7));
  for (int quarter = 0; quarter < 4; ++quarter) {
    HeadingTexture texture;
    texture.share[static_cast<std::size_t>(6 * quarter)] = 0.9;
    const auto motion = hand_held_motion(motion_preset(MotionPreset::sweep), span, box, 2, texture);
    ASSERT_TRUE(motion) << motion.error().message;
    Vector3d forward = Vector3d::Zero();
    Eigen::AlignedBox3d extent;
    for (std::size_t i = 0; i < motion->position_world_m.size(); ++i) {
      forward += motion->rotation_world_body[i] * Vector3d::UnitZ();
      extent.extend(motion->position_world_m[i]);
    }
    const Vector3d size = extent.sizes();
    const bool along_x = std::abs(forward.x()) > std::abs(forward.y());
    EXPECT_LT(std::abs(along_x ? forward.y() : forward.x()), 0.02 * forward.norm());
    EXPECT_GT(along_x ? size.y() : size.x(), 2 * (along_x ? size.x() : size.y()));
  }
}

}  // namespace
}  // namespace fusebench
