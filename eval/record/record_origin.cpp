#include "eval/record/record_origin.hpp"

#include <optional>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/process_meter.hpp"

namespace fusebench::record {

namespace {

std::string_view truth_word(const recording::Recording& recording) {
  if (recording.ground_truth.empty()) return "none";
  return recording.truth_label.empty() ? "given" : kPseudoTruthWord;
}

/// Nothing of a recording that was not read from images.
std::optional<RecordedCamera> recorded_camera(const recording::Recording& recording) {
  if (!recording.calibration) return std::nullopt;
  return RecordedCamera{recording.calibration->color, recording.calibration->depth_units_per_metre};
}

}  // namespace

std::vector<std::string> reading_notes(const recording::Recording& recording,
                                       const std::filesystem::path& folder) {
  std::string place = folder.string();
  while (place.size() > 1 && place.ends_with('/')) place.pop_back();
  const auto placed = [&](const std::string& text) {
    if (!text.starts_with(place + "/") && !text.starts_with(place + ":")) return text;
    return recording.name + text.substr(place.size());
  };
  std::vector<std::string> notes;
  for (const std::string& note : recording.notes) notes.push_back(placed(note));
  for (const std::string& warning : recording.warnings) notes.push_back("warning: " + placed(warning));
  return notes;
}

RecordedRecording recorded_recording(const recording::Recording& recording,
                                     const std::filesystem::path& folder, std::size_t first_frame) {
  return {.name = recording.name,
          .format = recording.format,
          .data = recording.simulated ? "simulated" : "recorded",
          .frames = recording.frames.size(),
          .first_frame = first_frame,
          .duration_s =
              seconds_between(recording.frames.front().timestamp_ns, recording.frames.back().timestamp_ns),
          .fingerprint = recording.fingerprint,
          .imu = std::string(recording::to_string(recording.imu_source)),
          .imu_note = recording.imu_note,
          .truth = std::string(truth_word(recording)),
          .notes = reading_notes(recording, folder),
          .camera = recorded_camera(recording),
          .start_ns = recording.frames.front().timestamp_ns,
          .whole_frames = recording.whole_frames};
}

RecordedProvenance provenance_here(int threads) {
  const BuildInfo& build = build_info();
  return {std::string(build.version),
          std::string(build.git),
          std::string(build.compiler),
          std::string(build.flags),
          std::string(build.estimator),
          cpu_model(),
          threads,
          host_name()};
}

Trajectory evaluated_truth(const recording::Recording& recording) {
  constexpr std::int64_t kMargin_ns = 1'000'000'000;
  Trajectory truth;
  if (recording.frames.empty()) return truth;
  for (const StampedPose& pose : recording.ground_truth) {
    if (pose.timestamp_ns >= recording.frames.front().timestamp_ns - kMargin_ns &&
        pose.timestamp_ns <= recording.frames.back().timestamp_ns + kMargin_ns)
      truth.push_back(pose);
  }
  return truth;
}

std::string evaluated_truth_text(const recording::Recording& recording) {
  return recording.ground_truth.empty() ? "" : trajectory::tum_text(evaluated_truth(recording));
}

std::vector<StampAndInstant> frame_stamps(const recording::Recording& recording) {
  std::vector<StampAndInstant> stamps;
  for (const recording::FrameEntry& frame : recording.frames)
    stamps.emplace_back(frame.timestamp_ns, frame.capture_ns);
  return stamps;
}

std::optional<SE3> true_camera(const recording::Recording& recording, std::int64_t instant_ns) {
  return trajectory::interpolate_pose(recording.ground_truth, instant_ns, trajectory::kMaxTruthGap_ns);
}

Trajectory true_trajectory(const recording::Recording& recording, std::span<const StampAndInstant> stamps) {
  return true_trajectory(recording.ground_truth, stamps);
}

Trajectory true_trajectory(const Trajectory& ground_truth, std::span<const StampAndInstant> stamps) {
  Trajectory truth;
  for (const auto& [stamp_ns, instant_ns] : stamps) {
    const auto pose = trajectory::interpolate_pose(ground_truth, instant_ns, trajectory::kMaxTruthGap_ns);
    if (pose) truth.push_back({stamp_ns, *pose});
  }
  return truth;
}

}  // namespace fusebench::record
