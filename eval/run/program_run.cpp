#include "eval/run/program_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/io/staged_folder.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "eval/external/program_results.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_folder.hpp"

namespace fusebench::run {

namespace {

std::string log_of(const std::string& version, const external::ProgramResults& results,
                   const record::RunRecord& record) {
  std::string log;
  if (!version.empty()) log += fmt::format("version: {}\n", version);
  for (const std::string& note : results.notes) log += note + "\n";
  log += fmt::format("{}: {} of {} frames have a pose; {}\n", record::to_string(record.status),
                     record.frames.tracked, record.frames.total,
                     record.reason.empty() ? results.end.how : record.reason);
  if (!results.end.output.empty()) log += "what the program printed last:\n" + results.end.output;
  return log;
}

record::RecordedTiming timing_of(const external::ProgramResults& results, std::size_t frames) {
  record::RecordedTiming timing;
  timing.wall_s = results.end.wall_s;
  timing.cpu_s = results.end.cpu_s;
  timing.peak_rss_bytes = results.end.peak_rss_bytes;
  timing.fps = timing.wall_s > 0 ? static_cast<double>(frames) / timing.wall_s : 0;
  return timing;
}

/// The stamps of all frames and of all poses, with the instants that they are of.
std::vector<record::StampAndInstant> all_stamps(const recording::Recording& recording,
                                                const std::vector<record::StampAndInstant>& of_poses) {
  std::vector<record::StampAndInstant> stamps = record::frame_stamps(recording);
  stamps.insert(stamps.end(), of_poses.begin(), of_poses.end());
  std::ranges::sort(stamps);
  stamps.erase(std::ranges::unique(stamps).begin(), stamps.end());
  return stamps;
}

}  // namespace

Result<record::RunRecord> execute_program_run(const PreparedRun& run, const RunControl& control) {
  const external::ExternalProgram& program = *run.spec.program;
  const recording::Recording& recording = run.recording;
  auto folder = io::StagedFolder::create(run.folder);
  if (!folder) return tl::unexpected(folder.error());
  const std::filesystem::path work = folder->file("work");
  std::error_code error;
  std::filesystem::create_directories(work, error);
  if (error)
    return fail(ErrorCode::io, fmt::format("{}: cannot be made: {}", work.string(), error.message()));
  const std::size_t total = recording.frames.size();
  const auto go_on = [&] {
    if (control.progress) control.progress(0, total);  // alive; how far it is, only the program knows
    return control.stop == nullptr || !control.stop->load();
  };
  auto results = external::run_external_program(
      program, recording, {run.spec.recording, work, run.spec.threads, run.spec.repetition}, go_on);
  if (!results) return tl::unexpected(results.error());
  std::filesystem::remove_all(work, error);

  RunOutput output;
  output.has_filter = false;
  output.trajectory = results->frames.poses;
  for (const auto& [stamp_ns, instant_ns] : results->frames.stamps) output.states.push_back({instant_ns, {}});
  output.mesh = std::move(results->mesh);
  record::RunRecord record = requested_record(run);
  record.status = results->reason.empty() ? record::RunStatus::ok : record::RunStatus::failed;
  record.reason = results->reason;
  record.frames.total = total;
  record.frames.tracked = output.trajectory.size();
  record.frames.lost = total - record.frames.tracked;
  record.model = {output.mesh.vertices.size(), output.mesh.triangles.size(), 0};
  record.metrics = metrics_of(output, recording, run.spec.config.values, Workers(run.spec.threads));
  record.timing = timing_of(*results, total);
  record.poses = program.trajectory.online ? record::PoseKind::online : record::PoseKind::final;
  const std::array<NamedText, 3> texts = {
      {{"trajectory.tum", trajectory::tum_text(output.trajectory)},
       {"truth.tum", trajectory::tum_text(
                         record::true_trajectory(recording, all_stamps(recording, results->frames.stamps)))},
       {"log.txt", log_of(program.version, *results, record)}}};
  Mesh* const mesh =
      run.spec.kept == KeptFiles::all && !output.mesh.vertices.empty() ? &output.mesh : nullptr;
  if (auto written = write_run_folder(*folder, mesh, texts, record); !written)
    return tl::unexpected(written.error());
  return record;
}

}  // namespace fusebench::run
