// The reader's conventions against published images: frames of ICL-NUIM lr kt2 must lie on each other when
// they are warped by their published poses, and must not when a convention is broken.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "tests/datasets/recording/formats/icl/icl_folder.hpp"

namespace fusebench {

using namespace trajectory;
using namespace recording;
using namespace formats::icl;
using namespace datasets;

namespace {

struct Residuals {
  std::vector<double> depth_m;
  std::vector<double> intensity;

  static double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }
};

template <typename T>
double bilinear(const Image<T>& image, double u, double v) {
  const int x = static_cast<int>(u);
  const int y = static_cast<int>(v);
  const double a = u - x;
  const double b = v - y;
  const auto value = [&](int i, int j) { return static_cast<double>(image(i, j)); };
  return (1 - b) * ((1 - a) * value(x, y) + a * value(x + 1, y)) +
         b * ((1 - a) * value(x, y + 1) + a * value(x + 1, y + 1));
}

/// Every pixel of frame a, projected into frame b.
Residuals warp(const RgbdFrame& a, const RgbdFrame& b, const PinholeCamera& camera, const SE3& T_b_a) {
  Residuals residuals;
  for (int v = 0; v < a.depth_m.height; ++v) {
    for (int u = 0; u < a.depth_m.width; ++u) {
      const double z = static_cast<double>(a.depth_m(u, v));
      if (z <= 0) continue;
      const Vector3d point_b = T_b_a * camera.back_project(u, v, z);
      if (point_b.z() <= 0) continue;
      const Vector2d p = camera.project(point_b);
      if (!(p.x() >= 0 && p.y() >= 0 && p.x() < camera.width_px - 1 && p.y() < camera.height_px - 1))
        continue;
      residuals.depth_m.push_back(std::abs(bilinear(b.depth_m, p.x(), p.y()) - point_b.z()));
      residuals.intensity.push_back(
          std::abs(bilinear(b.grey, p.x(), p.y()) - static_cast<double>(a.grey(u, v))));
    }
  }
  return residuals;
}

class IclReprojection : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = testing::shared_recording("icl_nuim_lr_kt2_frames1-3");
    if (!folder) GTEST_SKIP() << "FUSEBENCH_DATA does not hold icl_nuim_lr_kt2_frames1-3";
    auto recording = open_recording(*folder);
    ASSERT_TRUE(recording) << recording.error().message;
    recording_ = std::move(*recording);
    ASSERT_EQ(recording_.format, "icl");
    ASSERT_EQ(recording_.frames.size(), 3U);
    ASSERT_EQ(recording_.ground_truth.size(), 3U);
    EXPECT_TRUE(recording_.warnings.empty());
  }

  /// All ordered pairs of frames; pose: what is done to each pose.
  [[nodiscard]] Residuals all_pairs(const PinholeCamera& camera, SE3 (*pose)(const SE3&)) const {
    std::vector<RgbdFrame> frames;
    for (std::size_t i = 0; i < 3; ++i) frames.push_back(recording_.load_frame(i).value());
    Residuals all;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        if (a == b) continue;
        const SE3 T_b_a = pose(recording_.ground_truth[b].T_world_camera).inverse() *
                          pose(recording_.ground_truth[a].T_world_camera);
        const Residuals pair = warp(frames[a], frames[b], camera, T_b_a);
        all.depth_m.insert(all.depth_m.end(), pair.depth_m.begin(), pair.depth_m.end());
        all.intensity.insert(all.intensity.end(), pair.intensity.begin(), pair.intensity.end());
      }
    }
    return all;
  }

  static void report(const char* name, const Residuals& r) {
    std::printf(
        "[ measured ] %-34s median depth %.3f mm, median intensity %.3f grey levels, mean %.3f, %zu pixels\n",
        name, 1e3 * Residuals::median(r.depth_m), Residuals::median(r.intensity), mean(r.intensity),
        r.depth_m.size());
  }
  static double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }

  Recording recording_;
};

SE3 as_read(const SE3& pose) { return pose; }
SE3 no_motion(const SE3&) { return {}; }

TEST_F(IclReprojection, PublishedPosesPutFramesOntoEachOther) {
  PinholeCamera negative_fy = recording_.rig.camera;
  negative_fy.fy_px = -negative_fy.fy_px;
  const Residuals right = all_pairs(recording_.rig.camera, as_read);
  const Residuals unreflected = all_pairs(recording_.rig.camera, icl_reflect);
  const Residuals negative = all_pairs(negative_fy, as_read);
  const Residuals still = all_pairs(recording_.rig.camera, no_motion);
  report("as read", right);
  report("poses not reflected", unreflected);
  report("reflected poses, fy < 0", negative);
  report("no motion", still);
  for (const Residuals* wrong : {&unreflected, &negative, &still}) {
    EXPECT_LT(2 * Residuals::median(right.depth_m), Residuals::median(wrong->depth_m));
    EXPECT_LT(1.2 * mean(right.intensity), mean(wrong->intensity));
  }
}

/// The renderer's own convention is the same geometry: fy < 0 with poses as published.
TEST_F(IclReprojection, RendererConventionIsTheSameGeometry) {
  PinholeCamera published = recording_.rig.camera;
  published.fy_px = -published.fy_px;
  const Residuals right = all_pairs(recording_.rig.camera, as_read);
  const Residuals theirs = all_pairs(published, icl_reflect);
  EXPECT_NEAR(Residuals::median(theirs.depth_m), Residuals::median(right.depth_m), 1e-9);
  EXPECT_NEAR(mean(theirs.intensity), mean(right.intensity), 1e-6);
}

}  // namespace
}  // namespace fusebench
