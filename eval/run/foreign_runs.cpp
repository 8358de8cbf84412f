#include "eval/run/foreign_runs.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>
#include <utility>

#include "core/base/io/fingerprint.hpp"
#include "core/base/io/staged_folder.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "core/base/types.hpp"
#include "core/config/config_access.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/record/external/foreign_mesh.hpp"
#include "eval/record/external/frame_poses.hpp"
#include "eval/record/external/program_results.hpp"
#include "eval/record/external/system_name.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/truth_contradiction.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_folder.hpp"

namespace fusebench::run {

namespace {

/// What another system made of a recording as the output of a run.
RunOutput foreign_output(const external::FramePoses& frames, Mesh mesh) {
  RunOutput output;
  output.has_filter = false;
  output.trajectory = frames.poses;
  for (const auto& [stamp_ns, instant_ns] : frames.stamps) output.states.push_back({instant_ns, {}});
  output.mesh = std::move(mesh);
  return output;
}

/// Fills in the frames with and without a pose, the model, and the metrics.
void evaluate_foreign_output(const RunOutput& output, const recording::Recording& recording,
                             const config::Config& config, int threads, record::RunRecord& record) {
  record.frames.total = recording.frames.size();
  record.frames.tracked = output.trajectory.size();
  record.frames.lost = record.frames.total - record.frames.tracked;
  record.model = {output.mesh.vertices.size(), output.mesh.triangles.size(), 0};
  record.metrics = metrics_of(output, recording, config, Workers(threads));
  record::note_contradiction(record, record::true_trajectory(recording, record::frame_stamps(recording)),
                             output.trajectory);
}

Result<void> check_name(const std::string& name) {
  switch (external::fault_of_system_name(name)) {
    case external::NameFault::characters:
      return fail(ErrorCode::usage, fmt::format("'{}' is no name of a system", name),
                  "letters, digits, '-', '_', '+' and '.', as in ORB-SLAM3");
    case external::NameFault::is_variant:
      return fail(ErrorCode::usage, fmt::format("{} is a variant of this program", name),
                  "give the imported system a name of its own");
    case external::NameFault::none:
      break;
  }
  return {};
}

Result<recording::Recording> open(const ImportSpec& spec) {
  auto recording = open_window(spec.recording, spec.open, spec.frames);
  if (recording && recording->frames.empty())
    return fail(ErrorCode::data_corrupt, fmt::format("recording '{}' has no frames", recording->name));
  return recording;
}

Result<std::string> hash_of(const ImportSpec& spec, const recording::Recording& recording) {
  io::Fingerprint identity;
  for (const auto& file : {spec.trajectory.file, spec.mesh}) {
    if (file.empty()) continue;
    if (auto added = identity.add_file(file); !added) return tl::unexpected(added.error());
  }
  identity.add(recording.fingerprint);
  identity.add(spec.imu);
  const external::SystemTrajectory& poses = spec.trajectory;
  identity.add(fmt::format("{} {} {} {}",
                           poses.format ? trajectory_files::to_string(*poses.format) : "recognised",
                           poses.unit_m, poses.world_to_camera, poses.online));
  const PinholeCamera& camera = recording.rig.camera;
  identity.add(fmt::format("{} {} {} {} {} {}", camera.width_px, camera.height_px, camera.fx_px, camera.fy_px,
                           camera.cx_px, camera.cy_px));
  return identity.hex();
}

/// Two imports of one name over the same frames would be rows that nobody can tell apart.
Result<void> check_first_of_its_name(const ImportedRun& run) {
  const record::RunRecord& record = run.record;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(run.folder.parent_path(), error), end;
       !error && entry != end; entry.increment(error)) {
    if (entry->path().filename() == run.folder.filename()) continue;
    const auto other = run_files::found_run(entry->path());
    if (!other || other->record.program) continue;
    const record::RecordedRecording& recording = other->record.recording;
    if (other->record.poses != record.poses || recording.imu != record.recording.imu ||
        recording.fingerprint != record.recording.fingerprint)
      continue;
    return fail(
        ErrorCode::usage,
        fmt::format("{} of '{}' is imported already with other files: {}", record.variant,
                    record.recording.name, entry->path().string()),
        fmt::format("remove that folder, so that these take its place, or give these another NAME, as "
                    "{}-2",
                    record.variant));
  }
  return {};
}

Result<void> write(ImportedRun& run, RunOutput& output, const std::string& truth) {
  auto folder = io::StagedFolder::create(run.folder);
  if (!folder) return tl::unexpected(folder.error());
  const std::array<NamedText, 3> texts = {
      {{"trajectory.tum", trajectory::tum_text(output.trajectory)},
       {"truth.tum", truth},
       {"log.txt", fmt::format("imported: {} of {} frames have a pose\n", run.record.frames.tracked,
                               run.record.frames.total)}}};
  return write_run_folder(*folder, output.mesh.vertices.empty() ? nullptr : &output.mesh, texts, run.record);
}

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

Result<ImportedRun> import_run(const ImportSpec& spec) {
  if (auto named = check_name(spec.name); !named) return tl::unexpected(named.error());
  const auto recording = open(spec);
  if (!recording) return tl::unexpected(recording.error());
  ImportedRun run;
  const auto owned = external::read_system_trajectory(spec.trajectory, *recording, run.warnings);
  if (!owned) return tl::unexpected(owned.error());
  const auto hash = hash_of(spec, *recording);
  if (!hash) return tl::unexpected(hash.error());
  RunOutput output = foreign_output(*owned, {});
  if (!spec.mesh.empty()) {
    auto mesh = external::read_foreign_mesh(spec.mesh, spec.mesh_unit_m);
    if (!mesh) return tl::unexpected(mesh.error());
    output.mesh = std::move(*mesh);
  }

  record::RunRecord& record = run.record;
  record.status = record::RunStatus::ok;
  record.reason = "";
  record.recording =
      record::recorded_recording(*recording, spec.recording, spec.frames ? spec.frames->begin : 0);
  record.recording.imu = spec.imu;
  record.recording.imu_note = "";
  record.variant = spec.name;
  record.poses = spec.trajectory.online ? record::PoseKind::online : record::PoseKind::final;
  record.config_hash = *hash;
  run.folder = spec.out / recording->name / spec.name / hash->substr(0, 8);
  if (auto first = check_first_of_its_name(run); !first) return tl::unexpected(first.error());
  evaluate_foreign_output(output, *recording, config::EffectiveConfig{}.values(), spec.threads, record);
  record.provenance = record::provenance_here(spec.threads);
  if (auto written = write(run, output, record::evaluated_truth_text(*recording)); !written)
    return tl::unexpected(written.error());
  return run;
}

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
  evaluate_foreign_output(output, recording, run.spec.config.values(), run.spec.threads, record);
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
