#include "core/estimator/places/loops/pending_revisits.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace loops;

namespace {

/// The groups of options that these tests need.
struct RevisitOptions {
  config::DepthConfig depth;
  config::LoopsConfig loops;
  config::TsdfConfig tsdf;
};

constexpr double kWall_m = 1.5;

/// A camera in front of a wall that was fused long ago. Columns of its right half are new according to
/// `seen_columns`.
struct RevisitedWall {
  explicit RevisitedWall(int seen_columns) {
    config.loops.mode = config::LoopMode::online;
    RgbdFrame first = at(0.0, kWall_m);
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = seen_columns; x < camera.width_px; ++x) first.depth_m(x, y) = 0;
    }
    fuse(first);
  }

  [[nodiscard]] RgbdFrame at(double time_s, double wall_m) const {
    RgbdFrame frame;
    frame.timestamp_ns = static_cast<std::int64_t>(1e9 * (100 + time_s));
    frame.depth_m = DepthImage(camera.width_px, camera.height_px, static_cast<float>(wall_m));
    return frame;
  }
  void fuse(const RgbdFrame& frame) {
    ASSERT_TRUE(model.integrate(frame, camera, SE3{}, config.depth, workers));
  }
  std::optional<DepthImage> to_fuse(const RgbdFrame& frame) {
    return revisits.depth_to_fuse(model, frame, SE3{}, workers);
  }

  RevisitOptions config;
  PinholeCamera camera = testing::small_camera();
  Workers workers{1};
  tsdf::TsdfVolume model{config.tsdf};
  PendingRevisits revisits{config.depth, config.loops, camera};
};

int measured(const DepthImage& depth_m, int from_column, int to_column) {
  int count = 0;
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = from_column; x < to_column; ++x) count += depth_m(x, y) > 0 ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST(PendingRevisits, FusesNothingOverAnOldSurfaceThatDoesNotFit) {
  for (const double wall_m : {kWall_m - 0.06, kWall_m + 0.06}) {
    RevisitedWall wall(testing::small_camera().width_px);
    const auto rest_m = wall.to_fuse(wall.at(20, wall_m));
    ASSERT_TRUE(rest_m) << wall_m;
    // The old surface's own edge is all that is left.
    EXPECT_LT(measured(*rest_m, 0, wall.camera.width_px), wall.camera.width_px * wall.camera.height_px / 4);
  }
}

TEST(PendingRevisits, FusesWhatFitsAndWhatWasSeenLately) {
  RevisitedWall wall(testing::small_camera().width_px);
  EXPECT_FALSE(wall.to_fuse(wall.at(20, kWall_m + 0.004)));
  EXPECT_FALSE(wall.to_fuse(wall.at(wall.config.loops.least_age_s - 1, kWall_m + 0.06)));
  wall.fuse(wall.at(19, kWall_m));
  EXPECT_FALSE(wall.to_fuse(wall.at(20, kWall_m + 0.06)));
}

TEST(PendingRevisits, WaitsWhereMoreThanHalfOfTheOldSurfaceDoesNotFit) {
  for (const auto& [share_off, waits] : {std::pair{0.35, false}, std::pair{0.65, true}}) {
    RevisitedWall wall(testing::small_camera().width_px);
    RgbdFrame frame = wall.at(20, kWall_m);
    for (int y = 0; y < wall.camera.height_px; ++y) {
      for (int x = 0; x < share_off * wall.camera.width_px; ++x)
        frame.depth_m(x, y) = static_cast<float>(kWall_m + 0.06);
    }
    EXPECT_EQ(wall.to_fuse(frame).has_value(), waits) << share_off;
  }
}

TEST(PendingRevisits, FusesWhatIsSeenForTheFirstTime) {
  const int half = testing::small_camera().width_px / 2;
  RevisitedWall wall(half);
  const int margin = 32;
  const auto rest_m = wall.to_fuse(wall.at(20, kWall_m + 0.06));
  ASSERT_TRUE(rest_m);
  EXPECT_EQ(measured(*rest_m, margin, half - margin), 0);
  EXPECT_EQ(measured(*rest_m, half + margin, wall.camera.width_px),
            (wall.camera.width_px - half - margin) * wall.camera.height_px);
}

TEST(PendingRevisits, WaitsForALoopOnlySoLong) {
  RevisitedWall wall(testing::small_camera().width_px);
  const double longest_s = wall.config.loops.max_pending_s;
  EXPECT_TRUE(wall.to_fuse(wall.at(20, kWall_m + 0.06)));
  EXPECT_TRUE(wall.to_fuse(wall.at(20 + longest_s - 0.1, kWall_m + 0.06)));
  EXPECT_FALSE(wall.to_fuse(wall.at(20 + longest_s + 0.1, kWall_m + 0.06)));
  // A fitting frame in between starts a new revisit.
  EXPECT_FALSE(wall.to_fuse(wall.at(20 + longest_s + 0.2, kWall_m)));
  EXPECT_TRUE(wall.to_fuse(wall.at(20 + longest_s + 0.3, kWall_m + 0.06)));

  RevisitedWall never(testing::small_camera().width_px);
  never.config.loops.max_pending_s = 0;
  EXPECT_FALSE(never.to_fuse(never.at(20, kWall_m + 0.06)));
  RgbdFrame no_depth;  // which would be missed where the rays hit
  no_depth.timestamp_ns = never.at(20, kWall_m).timestamp_ns;
  EXPECT_FALSE(never.to_fuse(no_depth));
}

}  // namespace fusebench
