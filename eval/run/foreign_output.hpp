// The output of another system, imported or run as a program, in the form of a run's output.
#pragma once

#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/external/frame_poses.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_evaluation.hpp"

namespace fusebench::run {

[[nodiscard]] RunOutput foreign_output(const external::FramePoses& frames, Mesh mesh);

/// Fills in the frames with and without a pose, and the model.
void describe_foreign_output(const RunOutput& output, const recording::Recording& recording,
                             record::RunRecord& record);

}  // namespace fusebench::run
