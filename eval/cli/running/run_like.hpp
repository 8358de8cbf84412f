// The specification of a run from the record of another run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/console/run_request.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run.hpp"

namespace fusebench::cli::running {

/// The record in a file, or in the folder of a run. Errors: those of read_record(); usage for an
/// imported run, whose record has no command.
[[nodiscard]] Result<record::RunRecord> record_to_repeat(const std::filesystem::path& place);

/// The same variant, options, IMU, window and repetition over the recording of that name, or over the one
/// that the request names; the request's --set are applied after the recorded options. Errors: configuration
/// for an option that this program does not have; those of find_recording().
[[nodiscard]] Result<run::RunSpec> spec_like(const record::RunRecord& record,
                                             const console::RunRequest& request);

/// Sentences on differences from the recorded run: content of the recording, IMU or version of the estimator.
/// Empty: the results are the same.
[[nodiscard]] std::vector<std::string> differences(const record::RunRecord& record,
                                                   const run::PreparedRun& prepared);

}  // namespace fusebench::cli::running
