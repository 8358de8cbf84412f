#include "eval/run/run_placement.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "core/base/io/fingerprint.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/record/run_files/record_files.hpp"

namespace fusebench::run {

std::string run_identity(const RunSpec& spec, const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  io::Fingerprint identity;
  identity.add(config::config_hash(spec.config.values()));
  identity.add(recording.fingerprint);
  identity.add(recording::to_string(recording.imu_source));
  identity.add(recording.imu_note);
  identity.add(fmt::format("{} {} {} {} {} {}", camera.width_px, camera.height_px, camera.fx_px, camera.fy_px,
                           camera.cx_px, camera.cy_px));
  identity.add(spec.program ? spec.program->identity : record::build_info().estimator);
  if (is_prepared(spec, recording)) identity.add("prepared");
  if (spec.replicate > 0) identity.add(fmt::format("replicate {}", spec.replicate));
  return identity.hex();
}

RecordHead head_of(const run_files::FoundRun& run) {
  return {run.record.status,
          run.record.reason,
          run.record.run_id,
          run.state,
          run_files::missing_files(run.folder, run.record),
          run.record.model.vertices > 0};
}

std::optional<RecordHead> record_head(const std::filesystem::path& folder) {
  const auto run = run_files::found_run(folder);
  return run ? std::optional(head_of(*run)) : std::nullopt;
}

PreparedRun place_run(RunSpec spec, recording::Recording recording, const TakenFolders& taken) {
  PreparedRun run{std::move(spec), std::move(recording), {}, {}};
  run.run_id = run_identity(run.spec, run.recording);
  const std::string again = run.spec.repetition > 1 ? fmt::format("-r{}", run.spec.repetition) : "";
  const auto parent = run.spec.out / run.recording.name / run.spec.variant;
  for (const std::size_t digits : {std::size_t{8}, std::size_t{16}, run.run_id.size()}) {
    run.folder = parent / (run.run_id.substr(0, digits) + again);
    const auto there = record_head(run.folder);
    const auto planned = taken.find(run.folder);
    const bool of_another = there && !there->run_id.empty() && there->run_id != run.run_id;
    if (!of_another && (planned == taken.end() || planned->second == run.run_id)) break;
  }
  return run;
}

Result<PreparedRun> prepare_run(RunSpec spec) {
  if (auto related = config::check_relations(spec.config.values()); !related)
    return tl::unexpected(related.error());
  auto recording = open_for_run(spec);
  if (!recording) return tl::unexpected(recording.error());
  return place_run(std::move(spec), std::move(*recording));
}

record::RunRecord requested_record(const PreparedRun& run) {
  record::RunRecord record;
  record.recording = record::recorded_recording(run.recording, run.spec.recording,
                                                run.spec.frames ? run.spec.frames->begin : 0);
  record.recording.prepared = is_prepared(run.spec, run.recording);
  record.variant = run.spec.variant;
  for (const config::OptionRow& row : config::describe_options(run.spec.config.values())) {
    if (run.spec.program && !row.key.starts_with("evaluation.")) continue;
    record.config.push_back(
        {row.key, config::parse_option_value(row.value), run.spec.config.origin(row.key)});
  }
  record.config_hash =
      run.spec.program ? run.spec.program->identity : config::config_hash(run.spec.config.values());
  if (run.spec.program)
    record.program = {run.spec.program->definition, run.spec.program->version, seed_of(run.spec)};
  record.run_id = run.run_id;
  record.repetition = run.spec.repetition;
  record.replicate = run.spec.replicate;
  record.provenance = record::provenance_here(run.spec.threads);
  return record;
}

}  // namespace fusebench::run
