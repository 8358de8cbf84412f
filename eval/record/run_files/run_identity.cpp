#include "eval/record/run_files/run_identity.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

namespace fusebench::run_files {

namespace {

std::string value_text(const config::OptionValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

}  // namespace

bool is_edit(std::string_view origin) { return origin != "default" && !origin.starts_with("variant "); }

RunIdentity identity_of(const FoundRun& run) {
  const record::RunRecord& record = run.record;
  RunIdentity identity;
  identity.recording = record.recording.name;
  identity.fingerprint = record.recording.fingerprint;
  identity.data = record.recording.data;
  identity.imu = record.recording.imu;
  identity.truth = record.recording.truth;
  identity.first_frame = record.recording.first_frame;
  identity.frames = record.recording.frames;
  identity.whole_frames = record.recording.whole_frames;
  identity.variant = record.variant;
  for (const record::RecordedOption& option : record.config) {
    if (is_edit(option.origin)) identity.options.emplace_back(option.key, value_text(option.value));
  }
  identity.wrote_options = !record.config.empty() && !record.program;
  identity.config_hash = record.config_hash;
  identity.repetition = static_cast<std::size_t>(record.repetition);
  identity.replicate = static_cast<std::size_t>(record.replicate);
  identity.run = run.folder.filename().string();
  return identity;
}

RunIdentity without_replicate(RunIdentity identity) {
  identity.replicate = 0;
  identity.run.clear();
  identity.options.clear();  // config_hash is of their values
  identity.wrote_options = false;
  return identity;
}

RunIdentity without_repetition(RunIdentity identity) {
  identity.repetition = 1;
  return without_replicate(std::move(identity));
}

}  // namespace fusebench::run_files
