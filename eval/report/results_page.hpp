// A folder of runs as one page: tables, charts, patches and meshes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/report/frame_pictures.hpp"
#include "eval/report/recording_sections.hpp"

namespace fusebench::report {

struct ResultsPage {
  page::Page page;
  std::size_t tables = 0;             ///< of the sections: those before the first recording
  std::vector<std::string> warnings;  ///< what could not be read and is therefore not shown
};

/// As many runs as there are; details are thinned so that the page stays within some megabytes. title: shown
/// at the top. reader: of pictures of the recordings, which the runs do not keep. writer: of pictures of the
/// models, to which the page's tables then have links.
[[nodiscard]] ResultsPage results_page(const std::vector<run_files::FoundRun>& runs, const std::string& title,
                                       const FrameReader& reader = {}, const PictureWriter& writer = {});

}  // namespace fusebench::report
