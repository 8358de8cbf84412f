// What a record says of where its numbers come from: the recording, the machine and its truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/record/record.hpp"

namespace fusebench::record {

/// What was done to the data on reading, then "warning: ..." lines. Where a message begins with the
/// recording's folder, its name stands for it, so that the same recording elsewhere gives the same record.
[[nodiscard]] std::vector<std::string> reading_notes(const recording::Recording& recording,
                                                     const std::filesystem::path& folder);

/// first_frame: of a window of the recording.
[[nodiscard]] RecordedRecording recorded_recording(const recording::Recording& recording,
                                                   const std::filesystem::path& folder,
                                                   std::size_t first_frame);

/// Of this build on this machine.
[[nodiscard]] RecordedProvenance provenance_here(int threads);

/// The ground truth as it was read, which errors of the trajectory are computed against: from a second before
/// the first frame, which is further than any association looks, to a second after the last.
[[nodiscard]] Trajectory evaluated_truth(const recording::Recording& recording);

/// The text of a run's truth.tum: evaluated_truth(); empty where the recording has no truth.
[[nodiscard]] std::string evaluated_truth_text(const recording::Recording& recording);

/// A stamp that outputs name a pose by, and the instant that it was taken at.
using StampAndInstant = std::pair<std::int64_t, std::int64_t>;
[[nodiscard]] std::vector<StampAndInstant> frame_stamps(const recording::Recording& recording);

/// T_truth_camera of the colour camera at an instant; nothing where the ground truth does not reach.
[[nodiscard]] std::optional<SE3> true_camera(const recording::Recording& recording, std::int64_t instant_ns);

/// The true colour camera at each instant at which it is known (in gaps of at most 0.1 s), by the stamps.
[[nodiscard]] Trajectory true_trajectory(const recording::Recording& recording,
                                         std::span<const StampAndInstant> stamps);
/// The same from a ground truth that is not the recording's own, such as one on another clock.
[[nodiscard]] Trajectory true_trajectory(const Trajectory& ground_truth,
                                         std::span<const StampAndInstant> stamps);

}  // namespace fusebench::record
