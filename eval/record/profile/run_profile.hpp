// When a profiled run did what: for each of its frames the stretches of work, and their histograms.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/estimator/health/frame_report.hpp"
#include "core/estimator/health/stage_times.hpp"
#include "eval/record/duration_histogram.hpp"

namespace fusebench::profile {

struct FrameTimes {
  std::size_t frame = 0;  ///< as in frames.csv
  health::FrameStatus status = health::FrameStatus::lost;
  health::TimeSpan decode;  ///< reading and undistorting the images, on whichever thread
  health::TimeSpan images;  ///< until the run had them: decode itself, or waiting for it where it runs ahead
  health::StageTimes stages;
  health::TimeSpan output;  ///< rows and pixels of the frame

  /// All of it, in the thread of the run: images, stages, output, and the little between them.
  [[nodiscard]] health::TimeSpan frame_time() const { return {images.begin, output.end}; }
};

struct RunProfile {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  bool decodes_ahead = false;      ///< on a thread of its own
  std::vector<FrameTimes> frames;  ///< processed ones
  health::TimeSpan mesh;           ///< extraction of the model's surface, after the last frame
};

/// What traces and records call the time of a whole frame.
inline constexpr const char* kFrameName = "frame";

/// The histogram of each stage by name: decode, kStageNames, and kFrameName for all of a frame. One sample a
/// frame: the stage's time in it, of all its stretches together; frames that did without the stage (a lost
/// one fuses nothing) do not count. Stages that no frame had are left out.
[[nodiscard]] std::vector<std::pair<std::string, record::DurationHistogram>> stage_histograms(
    const RunProfile& profile);

}  // namespace fusebench::profile
