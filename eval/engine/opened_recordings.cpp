#include "eval/engine/opened_recordings.hpp"

#include <fmt/format.h>

#include "core/variants.hpp"

namespace fusebench {

const Result<Recording>& OpenedRecordings::of(const RunSpec& spec) {
  if (spec.recording != recording_) {
    opened_.clear();
    recording_ = spec.recording;
  }
  const std::string window = spec.frames ? fmt::format("{}:{}", spec.frames->begin, spec.frames->end) : "all";
  const std::string key = fmt::format("{} {} {}", window, static_cast<int>(spec.imu),
                                      needs_imu(spec.config.values) ? "imu" : "no imu");
  const auto found = opened_.find(key);
  if (found != opened_.end()) return found->second;
  return opened_.emplace(key, open_for_run(spec)).first->second;
}

}  // namespace fusebench
