#include "eval/cli/running/run_like.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>

#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/run_files/run_identity.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::cli::running {

namespace fs = std::filesystem;

namespace {

/// The variant's configuration with what the record has in place of its values, edited or of another version.
Result<config::EffectiveConfig> recorded_config(const record::RunRecord& record) {
  const auto variant = config::find_variant(record.variant);
  if (!variant) return tl::unexpected(variant.error());
  config::EffectiveConfig config = config::variant_config(*variant);
  for (const record::RecordedOption& option : record.config) {
    const bool edited = run_files::is_edit(option.origin);
    config::EffectiveConfig set = config;
    if (auto known = config::set_option(set.values(), option.key, option.value); !known) {
      Error error = known.error();
      error.message = fmt::format("the record's {}", error.message);
      return tl::unexpected(std::move(error));
    }
    if (!edited && config::config_hash(set.values()) == config::config_hash(config.values())) continue;
    if (auto done = config.set(option.key, option.value, edited ? option.origin : "record"); !done)
      return tl::unexpected(done.error());
  }
  return config;
}

run::ImuChoice imu_of(const record::RunRecord& record) {
  return record.recording.imu == "synthetic IMU" ? run::ImuChoice::synthetic : run::ImuChoice::recorded;
}

/// Finds the recording by its name, because a record does not contain its folder.
tl::unexpected<Error> not_found(const record::RunRecord& record, const fs::path& data, const Error& error) {
  const std::string and_so = data.empty() || error.hint.empty() ? "" : fmt::format("; {}", error.hint);
  return fail(
      error.code,
      fmt::format("the record is of '{}', which is not there: {}", record.recording.name, error.message),
      fmt::format("searched by this name in the current folder and in --data or FUSEBENCH_DATA; pass its "
                  "folder: `run RECORDING --like RECORD`{}",
                  and_so));
}

}  // namespace

Result<record::RunRecord> record_to_repeat(const fs::path& place) {
  std::error_code ignored;
  auto record = record::read_record(fs::is_directory(place, ignored) ? place / "record.json" : place);
  if (!record) return record;
  if (record->program || record->config.empty()) {
    return fail(ErrorCode::usage,
                fmt::format("{}: '{}' was not run by this program", place.string(), record->variant),
                record->program ? "--system FILE.toml runs an external program"
                                : "evaluate the output of another program with `fusebench import`");
  }
  return record;
}

Result<run::RunSpec> spec_like(const record::RunRecord& record, const console::RunRequest& request) {
  auto config = recorded_config(record);
  if (!config) return tl::unexpected(config.error());
  for (const std::string& assignment : request.sets) {
    if (auto set = config->set_assignment(assignment); !set) return tl::unexpected(set.error());
  }
  const auto folder = suites::find_recording(
      request.recording.empty() ? record.recording.name : request.recording, request.data);
  if (!folder && request.recording.empty()) return not_found(record, request.data, folder.error());
  if (!folder) return tl::unexpected(folder.error());
  auto open = console::open_options(request.reading);
  if (!open) return tl::unexpected(open.error());
  run::RunSpec spec;
  spec.recording = *folder;
  spec.open = std::move(*open);
  spec.imu = imu_of(record);
  spec.prepare = record.recording.prepared;
  spec.variant = record.variant;
  spec.config = std::move(*config);
  if (const std::size_t count = record.recording.frames; count > 0)
    spec.frames = run::FrameWindow{record.recording.first_frame, record.recording.first_frame + count};
  spec.threads = request.threads;
  spec.repetition = record.repetition;
  spec.replicate = record.replicate;
  return spec;
}

std::vector<std::string> differences(const record::RunRecord& record, const run::PreparedRun& prepared) {
  std::vector<std::string> sentences;
  if (prepared.run_id == record.run_id) return sentences;
  const recording::Recording& recording = prepared.recording;
  if (recording.fingerprint != record.recording.fingerprint) {
    sentences.push_back(
        fmt::format("recording '{}' has another content than that of the record", recording.name));
  } else if (recording.imu_note != record.recording.imu_note) {
    sentences.emplace_back("the IMU is not made as that of the record");
  }
  const std::string estimator(record::build_info().estimator);
  if (estimator != record.provenance.estimator) {
    sentences.push_back(
        fmt::format("this program has estimator {}, and {} made the record", estimator,
                    record.provenance.estimator.empty() ? "an older one" : record.provenance.estimator));
  }
  return sentences;
}

}  // namespace fusebench::cli::running
