// What a run was configured with, and by what and where it was made.
#pragma once

#include <string>

#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::report {

/// label: of the run, in the summary.
[[nodiscard]] page::PageDetails configuration_of(const run_files::FoundRun& run, const std::string& label);

}  // namespace fusebench::report
