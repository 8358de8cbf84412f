#include <cmath>
#include <optional>

#include "core/iekf.hpp"
#include "core/pipeline.hpp"
#include "tests/bench/patch_problem.hpp"
#include "tests/perf/kernel_counts.hpp"
#include "tests/support/simulated_frames.hpp"

namespace fusebench::perf {

namespace {

/// Iterations that do not end by themselves: a last digit must not decide how many there are.
void fix_iterations(IekfConfig& config) {
  config.converged_rotation_rad = 0;
  config.converged_translation_m = 0;
  config.max_iterations = 6;
}

void count_refresh(KernelCounts& counts, const testing::PatchProblem& problem, const Workers& workers) {
  std::vector<Patch> patches;
  counts.count(
      "refresh_patches", "patch",
      [&] {
        patches =
            refresh_patches(problem.reference(), problem.scene.model, {}, problem.scene.config, workers);
      },
      [&] {
        for (const Patch& patch : patches)
          check(!patch.levels.empty() && !patch.levels[0].pixels.empty(), "patches have pixels");
        check(patches.size() > 20, "the room has corners");
        return patches.size();
      });
}

void count_linearisation(KernelCounts& counts, const testing::PatchProblem& problem, const Workers& workers) {
  PatchMeasurement measurement(problem.scene.config, problem.rig, problem.observed, problem.patches, {},
                               workers);
  const int finest = measurement.stages() - 1;
  MeasurementQuadratic parts;
  testing::PatchProblem::Step step;
  counts.count(
      "linearise", "patch",
      [&] {
        parts = measurement.linearise({problem.start, problem.start}, finest, true);
      },
      [&] {
        step = problem.step_by(parts);
        check(problem.error_m(step.T_world_camera) < 0.5 * problem.error_m(problem.start),
              "the step leads to the true pose");
        return problem.patches.size();
      });

  double cost = 0;
  counts.count(
      "trial_cost", "patch",
      [&] {
        cost = measurement.trial_cost({step.T_world_camera, step.T_world_camera}, step.tangents, 1.0);
      },
      [&] {
        check(cost < parts.cost(), "the step lowers the cost");
        return problem.patches.size();
      });
}

/// A frame's update, from its patches on.
void count_update(KernelCounts& counts, const testing::PatchProblem& problem, const Workers& workers) {
  Config config = problem.scene.config;
  fix_iterations(config.iekf);
  GaussianState prior;
  prior.mean.T_world_imu = problem.start;
  prior.mean.T_world_imu_reference = problem.scene.T_world_camera;
  prior.covariance.diagonal().setConstant(1e-4);
  IekfResult result;
  counts.count(
      "iekf_update", "iteration",
      [&] {
        PatchMeasurement measurement(config, problem.rig, problem.observed, problem.patches, {}, workers);
        result = iekf_update(prior, measurement, config.iekf);
      },
      [&] {
        check(result.posterior.covariance.allFinite() &&
                  problem.error_m(result.posterior.mean.T_world_imu) < 0.3 * problem.error_m(problem.start),
              "the update leads to the true pose");
        return static_cast<std::size_t>(result.iterations);
      });
}

/// The fourth frame of a recording, with a rolling shutter.
void count_whole_frame(KernelCounts& counts, const Config& scene_config, const Workers& workers) {
  Config config = scene_config;
  fix_iterations(config.iekf);
  const testing::SimulatedRun run =
      testing::simulate(4, {.color_readout_s = 0.026, .depth_readout_s = 0.026, .depth_delay_s = 0.01});
  Pipeline pipeline(config, run.rig, run.imu, workers);
  std::size_t next = 0;
  std::optional<Result<FrameReport>> report;
  const auto process = [&] { report = pipeline.process(run.frames[next++]); };
  // The second one takes more than its share: the first is processed again with it.
  process();
  process();
  counts.count("process_frame", "pixel", process, [&] {
    check(report->has_value() && (*report)->status == FrameStatus::tracked, "the frame is tracked");
    const double error_m =
        ((*report)->T_world_camera.translation - run.T_first_camera[next - 1].translation).norm();
    check(error_m < 0.01, "the frame is tracked to where it was");
    return run.frames[next - 1].grey.data.size();
  });
}

}  // namespace

void count_tracking_kernels(KernelCounts& counts, const testing::BenchScene& scene) {
  const Workers workers(1);
  const testing::PatchProblem problem(scene, workers);
  count_refresh(counts, problem, workers);
  count_linearisation(counts, problem, workers);
  count_update(counts, problem, workers);
  count_whole_frame(counts, scene.config, workers);
}

}  // namespace fusebench::perf
