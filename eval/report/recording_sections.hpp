// The part of a page of results that is about one recording.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/report/frame_pictures.hpp"
#include "eval/report/runs_of_recording.hpp"
#include "eval/report/speed_failures/speed_sections.hpp"

namespace fusebench::report {

/// How much of each run a page of so many runs shows.
struct PageDetail {
  std::size_t buckets = 0;     ///< of charts over time
  std::size_t triangles = 0;   ///< of a mesh
  std::size_t in_between = 0;  ///< images of a recording for its time line
  int picture_width_px = 0;    ///< of the picture of a mesh
};

/// Writes the picture of a run's model beside the page, and returns the name of its file. run: recording and
/// label. Errors: io.
using PictureWriter = std::function<Result<std::string>(const std::string& run, const ColorImage& picture)>;

/// What is the same for all recordings of a page.
struct PageContext {
  const std::vector<run_files::FoundRun>& runs;
  std::vector<std::string> methods;  ///< one a run: its variant, with the options that not all runs share
  std::vector<std::size_t> colours;  ///< one a run
  PageDetail detail;
  const FrameReader& reader;
  const PictureWriter& writer;      ///< none: pictures are on the page alone
  std::span<std::string> pictures;  ///< one a run: the files of those that were written
};

struct RecordingSections {
  std::vector<page::PageSection> sections;
  std::vector<std::string> warnings;  ///< what could not be read and is therefore not shown
};

/// group: some of the context's runs. Its frames are added to those whose failures are counted by speed.
[[nodiscard]] RecordingSections recording_sections(RunsOfRecording group, const PageContext& context,
                                                   speed_failures::FailureSections& failures);

}  // namespace fusebench::report
