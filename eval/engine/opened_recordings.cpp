#include "eval/engine/opened_recordings.hpp"

#include <fmt/format.h>

#include <utility>

#include "datasets/open_recording.hpp"
#include "eval/engine/opening_trial.hpp"

namespace fusebench::engine {

void OpenedRecordings::open(const run::RunSpec& spec) {
  if (whole_ && spec.recording == recording_) return;
  views_.clear();
  recording_ = spec.recording;
  const auto open_it = [&] { return datasets::open_recording(spec.recording, spec.open); };
  if (auto tried = try_opening([&] { return open_it().map([](const auto&) {}); }, limits_, stop_); tried) {
    whole_ = open_it();
  } else {
    whole_ = tl::unexpected(tried.error());
  }
}

const Result<recording::Recording>& OpenedRecordings::of(const run::RunSpec& spec) {
  open(spec);
  if (!*whole_) return *whole_;
  std::string window = spec.frames ? run::to_string(*spec.frames) : "all";
  if (window != window_) {
    views_.clear();
    window_ = std::move(window);
  }
  const std::string key =
      fmt::format("{} {}", static_cast<int>(spec.imu), run::wants_imu(spec) ? "imu" : "no imu");
  const auto found = views_.find(key);
  if (found != views_.end()) return found->second;
  return views_.emplace(key, run::view_for_run(**whole_, spec)).first->second;
}

}  // namespace fusebench::engine
