#include "eval/run/program_run.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <system_error>
#include <utility>

#include "core/io/staged_folder.hpp"
#include "core/trajectory/trajectory_file.hpp"
#include "eval/external/program_results.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/record/truth_contradiction.hpp"
#include "eval/run/foreign_output.hpp"
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

record::RecordedTiming program_timing(const external::ProgramResults& results, std::size_t frames) {
  record::RecordedTiming timing;
  timing.wall_s = results.end.wall_s;
  timing.cpu_s = results.end.cpu_s;
  timing.peak_rss_bytes = results.end.peak_rss_bytes;
  timing.fps = timing.wall_s > 0 ? static_cast<double>(frames) / timing.wall_s : 0;
  return timing;
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
    return !control.is_stopped();
  };
  auto results = external::run_external_program(
      program, recording, {run.spec.recording, work, run.spec.threads, seed_of(run.spec)}, go_on);
  if (!results) return tl::unexpected(results.error());
  std::filesystem::remove_all(work, error);

  RunOutput output = foreign_output(results->frames, std::move(results->mesh));
  record::RunRecord record = requested_record(run);
  record.status = results->reason.empty() ? record::RunStatus::ok : record::RunStatus::failed;
  record.reason = results->reason;
  describe_foreign_output(output, recording, record);
  record.metrics = metrics_of(output, recording, run.spec.config.values(), Workers(run.spec.threads));
  record::note_contradiction(record, record::true_trajectory(recording, record::frame_stamps(recording)),
                             output.trajectory);
  record.timing = program_timing(*results, total);
  record.poses = program.trajectory.online ? record::PoseKind::online : record::PoseKind::final;
  const std::array<NamedText, 3> texts = {{{"trajectory.tum", trajectory::tum_text(output.trajectory)},
                                           {"truth.tum", record::evaluated_truth_text(recording)},
                                           {"log.txt", log_of(program.version, *results, record)}}};
  Mesh* const mesh =
      run.spec.kept == KeptFiles::all && !output.mesh.vertices.empty() ? &output.mesh : nullptr;
  if (auto written = write_run_folder(*folder, mesh, texts, record); !written)
    return tl::unexpected(written.error());
  return record;
}

}  // namespace fusebench::run
