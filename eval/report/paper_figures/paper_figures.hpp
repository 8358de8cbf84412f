// The figures of the paper from runs made here: speed of the recordings, patches under deformation, the
// experiment with and without an IMU, and reconstructions side by side.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/page/figures.hpp"
#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::paper_figures {

/// All runs of one recording.
struct RecordingRuns {
  std::string label;  ///< e.g. "slow"
  std::vector<run_files::FoundRun> runs;
};

struct WrittenFigures {
  std::vector<std::string> warnings;  ///< what could not be read and is therefore not shown
  page::Page page;                    ///< the same as a page
};

/// Writes figures, their scripts and their images into a folder. Charts and images are drawn by gnuplot.
/// Errors: io; usage where gnuplot is not installed.
[[nodiscard]] Result<WrittenFigures> write_paper_figures(std::span<const RecordingRuns> recordings,
                                                         const std::filesystem::path& folder,
                                                         page::FigureFormat format);

}  // namespace fusebench::paper_figures
