#include "eval/record/external/program_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "eval/record/external/foreign_mesh.hpp"
#include "eval/record/external/system_trajectory.hpp"

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
    recording::Recording without_truth = recording;  // a system that is judged does not see the ground truth
    without_truth.ground_truth.clear();
    const auto exported = exports::export_recording(without_truth, *program.input, input);
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

/// Nothing, or why the poses cannot be used.
Result<void> read_poses(const ExternalProgram& program, const recording::Recording& recording,
                        const fs::path& output, ProgramResults& results) {
  SystemTrajectory trajectory = program.trajectory;
  trajectory.file = output / trajectory.file;
  std::error_code ignored;
  if (!fs::exists(trajectory.file, ignored)) {
    return fail(
        ErrorCode::data_missing,
        fmt::format("{} wrote no trajectory: there is no {}, which trajectory.file of {} names", program.name,
                    program.trajectory.file.string(), program.file.filename().string()));
  }
  auto frames = read_system_trajectory(trajectory, recording, results.notes);
  if (!frames) return tl::unexpected(frames.error());
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

/// How a program ended that did not succeed, with the last line that it printed.
std::string reason_of(const ExternalProgram& program, const process::ProgramEnd& end) {
  std::string reason = fmt::format("{}: {}", program.command.front(), end.how);
  constexpr double kNearLimit = 0.5;  // what a program could not get, it did not use
  if (program.limits.memory_bytes > 0 &&
      static_cast<double>(end.peak_rss_bytes) > kNearLimit * static_cast<double>(program.limits.memory_bytes))
    reason += fmt::format(" (memory_mb = {:g} is its limit)",
                          static_cast<double>(program.limits.memory_bytes) / 1e6);
  const std::string_view printed =
      std::string_view(end.output).substr(0, end.output.find_last_not_of(" \r\n") + 1);  // of npos: 0
  if (!printed.empty()) reason += fmt::format(": {}", printed.substr(printed.rfind('\n') + 1));
  return reason;
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
    results.reason = reason_of(program, results.end);
    return results;
  }
  if (auto read = read_poses(program, recording, output, results); !read) {
    results.reason = without_folder(read.error().message, output);
  } else if (auto mesh = read_mesh(program.mesh, output, results); !mesh) {
    // A promise of the definition that is not kept: not the same as a system without a surface.
    results.reason = without_folder(mesh.error().message, output);
  }
  for (std::string& note : results.notes) note = without_folder(std::move(note), output);
  return results;
}

}  // namespace fusebench::external
