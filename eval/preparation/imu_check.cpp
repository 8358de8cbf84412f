#include "eval/preparation/imu_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>

#include "core/io/staged_file.hpp"
#include "datasets/inspection/inspection.hpp"
#include "eval/preparation/prepared_recording.hpp"

namespace fusebench::preparation {

namespace {

using inspection::Finding;
using inspection::Severity;

constexpr std::array<std::string_view, 5> kOfImu = {"imu-", "gyroscope-", "accelerometer-", "gravity-",
                                                    "extrinsic-"};
constexpr std::array<std::string_view, 6> kInvalidating = {
    "gyroscope-unit",     "accelerometer-unit", "accelerometer-without-gravity",
    "accelerometer-sign", "imu-axes-swapped",   "imu-unrelated"};

std::filesystem::path findings_file(const std::filesystem::path& out, const recording::Recording& recording) {
  return preparation_file(out, recording).replace_extension(".imu.txt");
}

bool is_of_imu(const Finding& finding) {
  return finding.severity != Severity::note &&
         std::ranges::any_of(kOfImu, [&](std::string_view of) { return finding.code.starts_with(of); });
}

/// A line a finding: severity, code, message and hint, separated by tabs.
std::string text_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += fmt::format("{}\t{}\t{}\t{}\n", to_string(finding.severity), finding.code, finding.message,
                        finding.hint);
  return text;
}

std::vector<Finding> findings_of(std::istream& text) {
  std::vector<Finding> findings;
  for (std::string line; std::getline(text, line);) {
    std::istringstream parts(line);
    std::string severity;
    Finding finding;
    std::getline(parts, severity, '\t');
    std::getline(parts, finding.code, '\t');
    std::getline(parts, finding.message, '\t');
    std::getline(parts, finding.hint, '\t');
    finding.severity = severity == to_string(Severity::error) ? Severity::error : Severity::warning;
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace

std::vector<Finding> imu_findings(const recording::Recording& recording, const std::filesystem::path& out,
                                  const Workers& workers) {
  const std::filesystem::path file = findings_file(out, recording);
  if (std::ifstream kept(file); kept) return findings_of(kept);
  std::vector<Finding> findings = inspection::inspect(recording, workers).findings;
  std::erase_if(findings, [](const Finding& finding) { return !is_of_imu(finding); });
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (!failed) std::ignore = io::write_file_atomically(file, text_of(findings));
  return findings;
}

bool makes_results_invalid(const Finding& finding) {
  return finding.severity == Severity::error &&
         std::ranges::find(kInvalidating, finding.code) != kInvalidating.end();
}

}  // namespace fusebench::preparation
