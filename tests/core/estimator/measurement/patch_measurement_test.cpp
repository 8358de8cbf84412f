#include "core/estimator/measurement/patch_measurement.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "core/config/config.hpp"
#include "tests/support/gated_depth.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace config;
using namespace filter;
using namespace tsdf;
using namespace patches;
using namespace measurement;

namespace {

/// A frame of the room, as tracking sees it.
struct SeenFrame {
  SeenFrame(const SE3& T_world_camera, const Config& config)
      : frame(testing::TexturedRoom{}.render(testing::small_camera(), T_world_camera, 0)) {
    frame.depth_m = testing::gated_depth(frame.depth_m, config.depth);
    pyramid = build_pyramid(frame.grey, config.patches.levels);
  }
  [[nodiscard]] ObservedFrame observed() const { return {pyramid, frame.depth_m}; }

  RgbdFrame frame;
  std::vector<GreyImage> pyramid;
};

/// Patches of the first frame, and two frames to find them in.
struct Scene {
  Scene() { rig.camera = testing::small_camera(); }

  [[nodiscard]] std::vector<Patch> cut(int max_count, Deformation deformation) const {
    TsdfVolume model(config.tsdf);
    EXPECT_TRUE(model.integrate(first.frame, rig.camera, SE3{}, config.depth, workers).has_value());
    PatchConfig own = config.patches;
    own.max_count = max_count;
    return refresh_patches({first.pyramid, first.frame.depth_m, rig.camera, SE3{}}, model, {},
                           {own, config.depth, deformation}, workers);
  }

  Config config;
  SensorRig rig;
  Workers workers{1};
  SeenFrame first{SE3{}, config};
  SeenFrame near{{so3_exp({0, 0.004, 0}), {0.004, 0, 0}}, config};
  SeenFrame aside{{so3_exp({0.01, -0.01, 0}), {-0.02, 0.01, 0}}, config};
};

void expect_same(const PoseQuadratic& a, const PoseQuadratic& b) {
  EXPECT_EQ(a.information, b.information);
  EXPECT_EQ(a.gradient, b.gradient);
  EXPECT_EQ(a.cost, b.cost);
}

/// All stages of an update, from where the patches were cut.
void expect_same(PatchMeasurement& kept, PatchMeasurement& fresh) {
  const PoseHypothesis still;
  for (int stage = 0; stage < fresh.stages(); ++stage) {
    const MeasurementQuadratic a = kept.linearise(still, stage, true);
    const MeasurementQuadratic b = fresh.linearise(still, stage, true);
    EXPECT_GT(b.by_reference.cost, 0);
    expect_same(a.by_reference, b.by_reference);
    expect_same(a.by_model, b.by_model);
  }
  ASSERT_EQ(kept.outcomes().size(), fresh.outcomes().size());
  for (std::size_t p = 0; p < fresh.outcomes().size(); ++p) {
    EXPECT_EQ(kept.outcomes()[p].usable_pixels, fresh.outcomes()[p].usable_pixels);
    EXPECT_EQ(kept.outcomes()[p].accepted, fresh.outcomes()[p].accepted);
    EXPECT_EQ(kept.outcomes()[p].gain, fresh.outcomes()[p].gain);
  }
  EXPECT_EQ(kept.tracked_pixels().intensity.size(), fresh.tracked_pixels().intensity.size());
}

TEST(PatchMeasurement, DoesNotDependOnAnEarlierFrame) {
  const Scene scene;
  const std::vector<Patch> many = scene.cut(60, Deformation::pixelwise);
  const std::vector<Patch> rigid = scene.cut(60, Deformation::rigid_square);
  const std::vector<Patch> few = scene.cut(15, Deformation::pixelwise);
  ASSERT_GT(many.size(), 2 * few.size());
  PatchMeasurement kept(scene.config, scene.rig, scene.workers);
  for (const std::vector<Patch>* patches : {&few, &rigid, &many, &few}) {
    // Something else before: another frame, a step, another brightness.
    kept.observe(scene.aside.observed(), rigid, {2.0, 2.0});
    static_cast<void>(kept.linearise({}, 0, false));
    static_cast<void>(kept.trial_cost({}, TangentVector::Constant(1e-3), 1.0));
    kept.accept();

    PatchMeasurement fresh(scene.config, scene.rig, scene.workers);
    kept.observe(scene.near.observed(), *patches, {});
    fresh.observe(scene.near.observed(), *patches, {});
    expect_same(kept, fresh);
  }
}

TEST(PatchMeasurement, PatchesFindTheirOwnPlaceFromAWrongPrediction) {
  Scene scene;
  scene.config.terms.deformation = Deformation::rigid_square;
  const std::vector<Patch> patches = scene.cut(40, Deformation::rigid_square);
  PatchMeasurement measurement(scene.config, scene.rig, scene.workers);
  // The same frame again with a prediction error of about 3 pixels: each square must return to its position.
  measurement.observe(scene.first.observed(), patches, {});
  static_cast<void>(measurement.linearise({}, measurement.stages() - 1, false));
  measurement.move_patches_alone(SE3{so3_exp({0.006, -0.009, 0}), {0, 0, 0}});
  std::size_t found = 0;
  std::size_t tracked = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const PatchOutcome& outcome = measurement.outcomes()[p];
    if (!outcome.tracked) continue;
    ++tracked;
    found += (outcome.centre_px - patches[p].centre_px.cast<double>()).norm() < 0.5 ? 1U : 0U;
  }
  EXPECT_GT(tracked, 20U);
  EXPECT_GE(found * 10, tracked * 8) << "of " << tracked << ", " << found << " are back";
}

TEST(PatchMeasurement, WholeSquaresHoldThePixelsOfAIEAndTheOthers) {
  Scene scene;
  const std::vector<Patch> patches = scene.cut(40, Deformation::pixelwise);
  PatchMeasurement plain(scene.config, scene.rig, scene.workers);
  plain.observe(scene.near.observed(), patches, {});
  static_cast<void>(plain.linearise({}, plain.stages() - 1, false));
  EXPECT_TRUE(plain.tracked_pixels().squares.empty()) << "nobody asked for them";

  scene.config.evaluation.intensity_readings = true;
  PatchMeasurement measurement(scene.config, scene.rig, scene.workers);
  measurement.observe(scene.near.observed(), patches, {});
  static_cast<void>(measurement.linearise({}, measurement.stages() - 1, false));
  const TrackedPixels tracked = measurement.tracked_pixels();
  std::vector<float> visible;
  for (const SquarePixel& pixel : tracked.squares) {
    if (pixel.visible) visible.push_back(pixel.difference_grey);
  }
  ASSERT_EQ(visible.size(), tracked.intensity.size());
  double sum = 0, expected = 0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    sum += static_cast<double>(visible[i]);
    expected += static_cast<double>(tracked.intensity[i].difference_grey);
  }
  EXPECT_NEAR(sum, expected, 1e-3 * expected);
  std::size_t seen = 0;
  for (const PatchOutcome& outcome : measurement.outcomes()) seen += outcome.tracked ? 1U : 0U;
  EXPECT_EQ(tracked.squares.size(), 100 * seen) << "no patch is at the border";
}

struct Measured {
  MeasurementQuadratic sum;
  double depth_measurements = 0;
  double depth_variance = 1;
};

Measured measured_near(Scene& scene, std::span<const Patch> patches, double common_error_share) {
  scene.config.geometric.common_error_share = common_error_share;
  PatchMeasurement measurement(scene.config, scene.rig, scene.workers);
  measurement.observe(scene.near.observed(), patches, {});
  Measured result;
  result.sum = measurement.linearise({}, measurement.stages() - 1, true);
  for (const PatchOutcome& outcome : measurement.outcomes()) {
    if (outcome.accepted)
      result.depth_measurements +=
          outcome.geometric_residuals / scene.config.geometric.pixels_per_measurement;
  }
  result.depth_variance = measurement.geometric_variance();
  return result;
}

TEST(PatchMeasurement, TheDepthOfAFrameCountsForALimitedNumberOfMeasurements) {
  // However many patches agree, a fixed error of the depth sensor is in all of them.
  Scene scene;
  const auto patches = scene.cut(60, Deformation::pixelwise);
  const Measured free = measured_near(scene, patches, 0);
  const Measured limited = measured_near(scene, patches, 2);
  ASSERT_GT(free.depth_measurements, 5.0);
  EXPECT_NEAR(limited.depth_variance, free.depth_variance + 4.0 * free.depth_measurements,
              1e-5 * limited.depth_variance);
  EXPECT_TRUE((limited.sum.by_model.information * limited.depth_variance)
                  .isApprox(free.sum.by_model.information * free.depth_variance, 1e-9));
  expect_same(free.sum.by_reference, limited.sum.by_reference);
  // Without an IMU the rotation of the camera is observable by images only.
  scene.config.terms.prior = Prior::constant_velocity;
  EXPECT_EQ(measured_near(scene, patches, 2).depth_variance, free.depth_variance);
}

TEST(PatchMeasurement, AnAnchorHasTheInformationThatColorHasOnTheFrame) {
  const Scene scene;
  const auto patches = scene.cut(60, Deformation::pixelwise);
  PatchMeasurement measurement(scene.config, scene.rig, scene.workers);
  measurement.observe(scene.near.observed(), patches, {});
  const MeasurementQuadratic sum = measurement.linearise({}, measurement.stages() - 1, false);
  EXPECT_TRUE(measurement.color_information().isApprox(sum.by_reference.information, 1e-9));
}

TEST(PatchMeasurement, WithoutAFrameThereIsNothingToMeasureBy) {
  const Scene scene;
  PatchMeasurement measurement(scene.config, scene.rig, scene.workers);
  EXPECT_THROW(static_cast<void>(measurement.linearise({}, 0, false)), InternalError);
}

}  // namespace
}  // namespace fusebench
