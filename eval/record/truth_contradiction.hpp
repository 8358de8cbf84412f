// Runs whose poses contradict the ground truth so grossly that one of the two is wrong.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/trajectory/trajectory.hpp"
#include "eval/record/record.hpp"

namespace fusebench::record {

/// "the poses contradict the ground truth: ATE 0.85 m, ..." if the estimate does not explain three quarters
/// of the variance of the true positions: if the ATE exceeds half of their rms distance from their mean, of
/// at least 0.1 m. Without an ATE, as where a ground truth that stands still cannot be aligned, the
/// difference of the extents of both takes its place, which is its lower bound. foreign: the poses are those
/// of another program, whose conventions may differ; the text names the checks for that.
[[nodiscard]] std::optional<std::string> truth_contradiction(const Trajectory& truth,
                                                             const Trajectory& estimate,
                                                             std::optional<double> ate_rmse_m,
                                                             bool foreign = false);

/// Adds it to the notes of a record whose status is ok. Of online and final poses, the better ones count.
void note_contradiction(RunRecord& record, const Trajectory& truth, const Trajectory& estimate);

/// That note, without "warning: ".
[[nodiscard]] std::optional<std::string> noted_contradiction(const RunRecord& record);

/// Whether a note of a record is that one.
[[nodiscard]] bool is_contradiction(std::string_view note);

}  // namespace fusebench::record
