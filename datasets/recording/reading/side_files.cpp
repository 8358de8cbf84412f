#include "datasets/recording/reading/side_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "core/base/printable.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/reader_words.hpp"
#include "datasets/recording/sensor_columns.hpp"
#include "datasets/recording/state_truth.hpp"

namespace fusebench::reading {

namespace {

constexpr std::size_t kLongestLabel = 200;

/// Positions of the ground truth are used in double precision only, but they must leave room for squares.
Result<void> check_positions(const Trajectory& truth, const std::filesystem::path& source) {
  for (const StampedPose& pose : truth) {
    const Vector3d& position_m = pose.T_world_camera.translation;
    if (position_m.cwiseAbs().maxCoeff() <= recording::kMaxPosition_m) continue;
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}: the pose at time {} has position ({:g}, {:g}, {:g}) m (allowed {:g} .. {:g})",
                    source.string(), trajectory::stamp_text(pose.timestamp_ns), position_m.x(),
                    position_m.y(), position_m.z(), -recording::kMaxPosition_m, recording::kMaxPosition_m),
        "remove its row, or subtract an origin from all positions");
  }
  return {};
}

}  // namespace

Result<void> set_ground_truth(recording::Recording& recording, Trajectory truth,
                              const std::filesystem::path& source, std::size_t published_without) {
  if (auto sane = check_positions(truth, source); !sane) return sane;
  const std::int64_t first_ns = recording.frames.front().timestamp_ns;
  const std::int64_t last_ns = recording.frames.back().timestamp_ns;
  if (truth.front().timestamp_ns > last_ns || truth.back().timestamp_ns < first_ns) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: ground truth (times {} to {}) does not overlap the images (times {} to {})",
                            source.string(), trajectory::stamp_text(truth.front().timestamp_ns),
                            trajectory::stamp_text(truth.back().timestamp_ns),
                            trajectory::stamp_text(first_ns), trajectory::stamp_text(last_ns)),
                "the ground truth must be of the same recording and clock, in seconds");
  }
  const auto is_uncovered = [&](const recording::FrameEntry& frame) {
    return !trajectory::interpolate_pose(truth, frame.timestamp_ns, trajectory::kMaxTruthGap_ns);
  };
  const auto uncovered = static_cast<std::size_t>(std::ranges::count_if(recording.frames, is_uncovered));
  const bool as_published = uncovered <= published_without && is_uncovered(recording.frames.front());
  if (uncovered > 0) {
    (as_published ? recording.notes : recording.warnings)
        .push_back(fmt::format("{}: {} of {} {} within {} s", source.string(), uncovered,
                               recording.frames.size(), recording::kUncoveredByTruth,
                               seconds_between(0, trajectory::kMaxTruthGap_ns)));
  }
  recording.ground_truth = std::move(truth);
  return {};
}

void label_truth(std::string_view label, recording::Recording& recording) {
  check(label.starts_with(recording::kPseudoTruthBeginning), "the label says that it is no truth");
  recording.truth_label = label;
  recording.notes.push_back(fmt::format("ground truth: {}", label));
}

Result<void> read_ground_truth_beside(const std::filesystem::path& folder, recording::Recording& recording) {
  const std::filesystem::path file = folder / "groundtruth.txt";
  if (!io::is_named(file)) return {};
  // The published truth of freiburg2_desk repeats a stamp; TUM's own scripts keep the last of such rows.
  auto truth =
      trajectory::read_tum_trajectory(file, recording.warnings, trajectory::Duplicates::last_in_order);
  if (!truth) return tl::unexpected(truth.error());
  std::ifstream stream = io::input_file(file);
  if (std::string first; io::next_line(stream, first) && first.starts_with("# ") &&
                         first.substr(2).starts_with(recording::kPseudoTruthBeginning)) {
    while (first.ends_with('\r')) first.pop_back();
    label_truth(printable(first.substr(2), kLongestLabel), recording);
  }
  return set_ground_truth(recording, std::move(*truth), file);
}

Result<std::vector<ImuSample>> read_imu_table(const std::filesystem::path& file, io::TimeUnit unit) {
  std::vector<ImuSample> samples;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto rate_radps = recording::read_angular_velocity(table, 1, "w");
    if (!rate_radps) return tl::unexpected(rate_radps.error());
    const auto force_mps2 = recording::read_specific_force(table, 4, "a");
    if (!force_mps2) return tl::unexpected(force_mps2.error());
    samples.push_back({time_ns, *rate_radps, *force_mps2});
    return {};
  };
  const Result<void> done =
      io::for_each_stamped_row(file, "timestamp wx wy wz ax ay az", io::TimeOrder::increasing, row, unit);
  if (!done) return tl::unexpected(done.error());
  return samples;
}

Result<void> read_imu_beside(const std::filesystem::path& folder, recording::Recording& recording) {
  const std::filesystem::path file = folder / "imu.csv";
  if (!io::is_named(file)) return {};
  auto samples = read_imu_table(file, io::TimeUnit::nanoseconds);
  if (!samples) return tl::unexpected(samples.error());
  recording.imu = std::move(*samples);
  recording.imu_source = recording::ImuSource::recorded;
  return {};
}

Result<void> read_exact_truth_beside(const std::filesystem::path& folder, recording::Recording& recording) {
  if (const auto mesh = folder / "scene.ply"; io::is_named(mesh)) recording.truth_mesh_file = mesh;
  const std::filesystem::path file = folder / "state_groundtruth.csv";
  if (!io::is_named(file)) return {};
  auto states = recording::read_state_truth(file);
  if (!states) return tl::unexpected(states.error());
  recording.state_truth = std::move(*states);
  return {};
}

void note_simulation(const std::filesystem::path& folder, recording::Recording& recording) {
  for (const std::string& name :
       {std::string(kSimulationFile), fmt::format("{}.{}", recording.name, kSimulationFile)}) {
    if (!io::is_named(folder / name)) continue;
    recording.simulated = true;
    recording.notes.push_back(fmt::format("simulated: {} says how it was made", name));
    return;
  }
}

}  // namespace fusebench::reading
