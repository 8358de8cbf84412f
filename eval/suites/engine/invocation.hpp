// What was asked of an engine, kept beside its runs: so that failed runs can be run again, and other machines
// can take a share, without anybody repeating the command.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::engine {

/// How a suite's file is changed on the command line.
struct SuiteOverrides {
  int repetitions = 0;  ///< 0: the suite's
  int replicates = 0;   ///< 0: the suite's
  std::string kept;     ///< empty: the suite's
};

struct Invocation {
  std::filesystem::path suite;  ///< its file
  BatchOptions options;
  SuiteOverrides overrides;
  std::filesystem::path working_folder = {};  ///< that relative folders in the suite are relative to
};

/// Where they are kept for a folder of runs: <out>/.fusebench/invocations.
[[nodiscard]] std::filesystem::path invocations_folder(const std::filesystem::path& out);

/// The suite as this invocation runs it. Errors: those of read_suite(), usage for overrides.
[[nodiscard]] Result<suites::Suite> suite_of(const Invocation& invocation);

/// Keeps it, with a copy of the suite's file and absolute folders, as
/// <out>/.fusebench/invocations/<hash8>.{json,toml}; the same one once. Returns the file. Error io.
[[nodiscard]] Result<std::filesystem::path> keep(const Invocation& invocation);

/// What was requested in one folder of runs is kept in another as well, as far as it can be written. Returns
/// how many were left out, since they or their suites cannot be read.
std::size_t copy_invocations(const std::filesystem::path& from, const std::filesystem::path& into);

/// Errors: data_missing; data_corrupt for what is no invocation.
[[nodiscard]] Result<Invocation> read_invocation(const std::filesystem::path& file);

/// All that were kept in the folder of runs, by name. Error data_missing if there are none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> kept_invocations(const std::filesystem::path& out);

}  // namespace fusebench::engine
