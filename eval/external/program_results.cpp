#include "eval/external/program_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/trajectory/association.hpp"
#include "eval/external/foreign_mesh.hpp"
#include "eval/external/system_trajectory.hpp"
#include "eval/trajectory_files/stamps.hpp"

namespace fusebench::external {

namespace {

namespace fs = std::filesystem;

/// What stands for a placeholder in this run.
using Placeholders = std::vector<std::pair<std::string, std::string>>;

std::string filled_in(std::string argument, const Placeholders& placeholders) {
  for (const auto& [name, value] : placeholders) {
    const std::string key = fmt::format("{{{}}}", name);
    for (std::size_t at = argument.find(key); at != std::string::npos;
         at = argument.find(key, at + value.size()))
      argument.replace(at, key.size(), value);
  }
  return argument;
}

/// Writes what the program reads, and says where it is.
Result<Placeholders> prepare_input(const ExternalProgram& program, const recording::Recording& recording,
                                   const ProgramPlace& place, ProgramResults& results) {
  fs::path input = place.recording_folder;
  fs::path calibration;
  if (program.input) {
    input = place.work_folder / "export";
    recording::Recording untold = recording;  // a system that is judged does not see the truth
    untold.ground_truth.clear();
    const auto exported = exports::export_recording(untold, *program.input, input);
    if (!exported) return tl::unexpected(exported.error());
    results.notes = exported->notes;
    calibration = exported->calibration;
  }
  std::error_code ignored;
  return Placeholders{{"recording", fs::absolute(input, ignored).string()},
                      {"calibration", fs::absolute(calibration, ignored).string()},
                      {"output", fs::absolute(place.work_folder / "output", ignored).string()},
                      {"folder", program.folder().string()},
                      {"threads", std::to_string(place.threads)},
                      {"seed", std::to_string(place.seed)}};
}

Result<trajectory_files::LoadedTrajectory> load_poses(const ProgramTrajectory& trajectory,
                                                      const fs::path& file, std::vector<std::string>& notes) {
  auto loaded = load_system_trajectory(file, trajectory.format, notes);
  if (!loaded) return loaded;
  for (StampedPose& pose : loaded->poses) {
    pose.T_world_camera.translation *= trajectory.unit_m;
    if (trajectory.world_to_camera) pose.T_world_camera = pose.T_world_camera.inverse();
  }
  return loaded;
}

double extent_m(const Trajectory& poses) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : poses) box.extend(pose.T_world_camera.translation);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Poses in another unit are mistaken for bad ones; a factor of a hundred is no bad tracking.
Result<void> check_scale(const Trajectory& poses, const recording::Recording& recording,
                         const std::string& file) {
  constexpr double kFactor = 100;
  Trajectory truth;
  for (const StampedPose& pose : recording.ground_truth) {
    if (pose.timestamp_ns >= poses.front().timestamp_ns && pose.timestamp_ns <= poses.back().timestamp_ns)
      truth.push_back(pose);
  }
  const double is_m = extent_m(poses), should_be_m = extent_m(truth);
  if (!(should_be_m > 0) || (is_m <= kFactor * should_be_m)) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}: the poses extend over {:.3g} m, and the truth over {:.3g} m: is the unit right?", file,
                  is_m, should_be_m));
}

/// Nothing, or why the poses cannot be used.
Result<void> read_poses(const ExternalProgram& program, const recording::Recording& recording,
                        const fs::path& output, ProgramResults& results) {
  auto loaded = load_poses(program.trajectory, output / program.trajectory.file, results.notes);
  if (!loaded) return tl::unexpected(loaded.error());
  auto frames = poses_of_frames(std::move(*loaded), recording);
  if (!frames)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: {}", program.trajectory.file, frames.error().message));
  if (auto checked = check_scale(frames->poses, recording, program.trajectory.file); !checked) return checked;
  results.frames = std::move(*frames);
  return {};
}

Result<void> read_mesh(const ProgramMesh& mesh, const fs::path& output, ProgramResults& results) {
  if (mesh.file.empty()) return {};
  auto read = read_foreign_mesh(output / mesh.file, mesh.unit_m);
  if (!read) return tl::unexpected(read.error());
  results.mesh = std::move(*read);
  return {};
}

/// Paths of this run's own folder say nothing to a reader.
std::string without_folder(std::string text, const fs::path& folder) {
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at))
    text.erase(at, prefix.size());
  return text;
}

}  // namespace

Result<ProgramResults> run_external_program(const ExternalProgram& program,
                                            const recording::Recording& recording, const ProgramPlace& place,
                                            const std::function<bool()>& go_on) {
  ProgramResults results;
  const fs::path output = place.work_folder / "output";
  std::error_code error;
  fs::create_directories(output, error);
  if (error)
    return fail(ErrorCode::io, fmt::format("{}: cannot be made: {}", output.string(), error.message()));
  const auto placeholders = prepare_input(program, recording, place, results);
  if (!placeholders) return tl::unexpected(placeholders.error());
  std::vector<std::string> command;
  for (const std::string& argument : program.command) command.push_back(filled_in(argument, *placeholders));
  auto end = process::run_program(command, output, program.limits, go_on);
  if (!end) return tl::unexpected(end.error());
  results.end = std::move(*end);
  if (!results.end.succeeded) {
    results.reason = fmt::format("{}: {}", program.command.front(), results.end.how);
    return results;
  }
  if (auto read = read_poses(program, recording, output, results); !read) {
    results.reason = without_folder(read.error().message, output);
  } else if (auto mesh = read_mesh(program.mesh, output, results); !mesh) {
    results.notes.push_back("warning: " + without_folder(mesh.error().message, output));
  }
  for (std::string& note : results.notes) note = without_folder(std::move(note), output);
  return results;
}

}  // namespace fusebench::external
