#include "datasets/inspection/inspection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "datasets/inspection/checks.hpp"
#include "datasets/recording/reader_words.hpp"

namespace fusebench::inspection {

void Inspection::add(std::string_view code, Severity severity, std::string message, std::string hint) {
  check(std::ranges::any_of(finding_codes(), [&](const FindingCode& known) { return known.code == code; }),
        "the code of a finding is in finding_codes()");
  findings.push_back({std::string(code), severity, std::move(message), std::move(hint)});
}

bool Inspection::has(std::string_view code) const {
  return std::ranges::any_of(findings, [&](const Finding& finding) { return finding.code == code; });
}

std::size_t Inspection::count(Severity severity) const {
  return static_cast<std::size_t>(std::ranges::count(findings, severity, &Finding::severity));
}

Inspection refused_inspection(const std::string& recording, const std::string& format, const Error& error) {
  Inspection out;
  out.recording = recording;
  out.format = format;
  out.add("cannot-open", Severity::error, error.message, error.hint);
  return out;
}

namespace {

/// What the reader said and a check says again, with a hint.
void say_once(Inspection& out) {
  if (!out.has("truth-coverage")) return;
  std::erase_if(out.findings, [](const Finding& finding) {
    return finding.code.starts_with("reader-") &&
           finding.message.find(recording::kUncoveredByTruth) != std::string::npos;
  });
}

}  // namespace

Inspection inspect(const recording::Recording& recording, const Workers& workers,
                   const InspectOptions& options) {
  check(!recording.frames.empty(), "a recording that was opened has frames");
  Inspection out;
  out.recording = recording.name;
  out.format = recording.format;
  out.fingerprint = recording.fingerprint;
  out.frames = recording.frames.size();
  out.imu_source = recording.imu_source;
  for (const std::string& warning : recording.warnings) out.add("reader-warning", Severity::warning, warning);
  for (const std::string& note : recording.notes) out.add("reader-note", Severity::note, note);
  if (options.expected_frames && *options.expected_frames != out.frames) {
    out.add("frames-incomplete", Severity::warning,
            fmt::format("there are {} frames; the recording is published with {}", out.frames,
                        *options.expected_frames),
            "download or unpack it again; results of a part are not those of the whole");
  }
  check_frame_stamps(recording, out);
  check_truth_stamps(recording, out);
  check_imu_stamps(recording, out);
  const std::optional<recording::Recording> repaired = leave_out_imu_faults(recording, out);
  const recording::Recording& sound = repaired ? *repaired : recording;
  check_imu_values(sound, out);
  check_images(sound, workers, options, out);
  check_reprojection(sound, workers, options, out);
  check_truth_moves(sound, workers, out);
  check_imu_alignment(sound, workers, options, out);
  check_imu_axes(sound, out);
  check_accelerometer(sound, out);
  check_motion(sound, out);
  check_repeated_images(sound, out);
  check_registration(sound, workers, out);
  say_once(out);
  std::ranges::stable_sort(out.findings, {}, &Finding::severity);
  return out;
}

}  // namespace fusebench::inspection
