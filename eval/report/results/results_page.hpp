// A folder of runs as one page: tables, charts, patches and meshes.
#pragma once

#include <string>
#include <vector>

#include "eval/found_runs.hpp"
#include "eval/report/page.hpp"

namespace fusebench {

struct ResultsPage {
  Page page;
  std::vector<std::string> warnings;  ///< what could not be read and is therefore not shown
};

/// As many runs as there are; details are thinned so that the page stays within some megabytes. title: shown
/// at the top.
[[nodiscard]] ResultsPage results_page(const std::vector<FoundRun>& runs, const std::string& title);

}  // namespace fusebench
