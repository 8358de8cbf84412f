// A run that is asked for by the record of another one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/console/run_request.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run.hpp"

namespace fusebench::cli::running {

/// The record in a file, or in the folder of a run. Errors: those of read_record(); usage for a run of
/// another program, which a record does not say how to call.
[[nodiscard]] Result<record::RunRecord> record_to_repeat(const std::filesystem::path& place);

/// The same variant, options, IMU, window and repetition over the recording of that name, or over the one
/// that the request names; the request's --set are applied after the recorded options. Errors: configuration
/// for an option that this program does not have; those of find_recording().
[[nodiscard]] Result<run::RunSpec> spec_like(const record::RunRecord& record,
                                             const console::RunRequest& request);

/// What is different from the recorded run, in sentences: another content of the recording, another IMU or
/// another version of the estimator. Empty: the results are the same.
[[nodiscard]] std::vector<std::string> differences(const record::RunRecord& record,
                                                   const run::PreparedRun& prepared);

}  // namespace fusebench::cli::running
