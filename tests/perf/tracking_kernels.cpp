#include <optional>

#include "core/config/config.hpp"
#include "core/recording_estimator.hpp"
#include "tests/bench/bench_scene.hpp"
#include "tests/bench/patch_answers.hpp"
#include "tests/perf/kernel_counts.hpp"
#include "tests/support/simulated_frames.hpp"

namespace fusebench::perf {

using namespace simd;
using namespace config;
using namespace filter;
using namespace patches;
using namespace measurement;
using namespace health;
using namespace core;

namespace {

void count_refresh(KernelCounts& counts, const testing::PatchProblem& problem, const Workers& workers) {
  PatchWorkspace memory;
  std::vector<Patch> patches;
  counts.count(
      "refresh_patches", "patch",
      [&] {
        refresh_patches(problem.reference(), problem.scene.model, {},
                        {problem.config.patches, problem.config.depth, problem.config.terms.deformation},
                        workers, memory, patches);
      },
      [&] {
        check(testing::are_cut_from(patches, problem.reference()), "patches are cut from the frame");
        return patches.size();
      });
}

void count_linearisation(KernelCounts& counts, const testing::PatchProblem& problem, const Workers& workers) {
  const auto in_frame = problem.measurement(workers);
  PatchMeasurement& measurement = *in_frame;
  const int finest = measurement.stages() - 1;
  const SE3 start = problem.start();
  MeasurementQuadratic parts;
  testing::PatchProblem::Step step;
  counts.count(
      "linearise", "patch",
      [&] {
        parts = measurement.linearise({start, start}, finest, true);
      },
      [&] {
        step = testing::PatchProblem::step_by(parts, start);
        check(problem.error_m(step.T_world_camera) < 0.5 * problem.error_m(start),
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
  const GaussianState prior = problem.prior();
  IekfResult result;
  counts.count(
      "iekf_update", "iteration", [&] { result = problem.update(prior, workers); },
      [&] {
        check(problem.is_updated(result), "the update leads to the true pose");
        return static_cast<std::size_t>(result.iterations);
      });
}

/// The fourth frame of a recording, with a rolling shutter.
void count_whole_frame(KernelCounts& counts, const Config& config, const Workers& workers) {
  const testing::SimulatedRun run =
      testing::simulate(4, {.color_readout_s = 0.026, .depth_readout_s = 0.026, .depth_delay_s = 0.01});
  RecordingEstimator pipeline(config, run.rig, run.imu, workers);
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
  count_whole_frame(counts, problem.config, workers);
}

}  // namespace fusebench::perf
