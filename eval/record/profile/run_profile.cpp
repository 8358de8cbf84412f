#include "eval/record/profile/run_profile.hpp"

#include <utility>

namespace fusebench::profile {

std::vector<std::pair<std::string, record::DurationHistogram>> stage_histograms(const RunProfile& profile) {
  std::vector<std::pair<std::string, record::DurationHistogram>> histograms;
  const auto add = [&](std::string_view name, const auto& duration_ms_of) {
    std::vector<double> durations_ms;
    for (const FrameTimes& frame : profile.frames) {
      const double duration_ms = duration_ms_of(frame);
      if (duration_ms > 0) durations_ms.push_back(duration_ms);
    }
    if (!durations_ms.empty())
      histograms.emplace_back(std::string(name), record::histogram_of(std::move(durations_ms)));
  };
  add("decode", [](const FrameTimes& frame) { return frame.decode.milliseconds(); });
  for (std::size_t stage = 0; stage < health::kStageNames.size(); ++stage) {
    add(health::kStageNames[stage], [&](const FrameTimes& frame) { return frame.stages.sums_ms()[stage]; });
  }
  add(kFrameName, [](const FrameTimes& frame) { return frame.frame_time().milliseconds(); });
  return histograms;
}

}  // namespace fusebench::profile
