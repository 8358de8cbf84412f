#include "eval/engine/opened_recordings.hpp"

#include <fmt/format.h>

namespace fusebench::engine {

const Result<recording::Recording>& OpenedRecordings::of(const run::RunSpec& spec) {
  if (spec.recording != recording_) {
    opened_.clear();
    recording_ = spec.recording;
  }
  const std::string window = spec.frames ? run::to_string(*spec.frames) : "all";
  const std::string key =
      fmt::format("{} {} {}", window, static_cast<int>(spec.imu), run::wants_imu(spec) ? "imu" : "no imu");
  const auto found = opened_.find(key);
  if (found != opened_.end()) return found->second;
  return opened_.emplace(key, run::open_for_run(spec)).first->second;
}

}  // namespace fusebench::engine
