// What stands at the head of a page of runs: what was found, what was compared, and the tables of all runs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::report {

/// In the order in which they are read. The first has the answer. pictures: files with pictures of the
/// models, one a run; empty: none.
[[nodiscard]] std::vector<page::PageSection> summary_sections(const std::vector<run_files::FoundRun>& runs,
                                                              std::span<const std::string> pictures);

}  // namespace fusebench::report
