// Our pipeline and its peers over one recording: frame by frame, one after the other, in one process.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "datasets/recording/recording.hpp"
#include "tests/bench/peers/answers.hpp"
#include "tests/bench/peers/contestant.hpp"

namespace fusebench::peers {

/// One contestant at one task.
struct Entrant {
  std::string name;
  std::string settings;
  std::string package = {};                      ///< empty for ours
  std::optional<Task> task;                      ///< nothing for all of our pipeline
  std::string missing = {};                      ///< why there is no time; empty if there is
  std::vector<std::vector<double>> cpu_ms = {};  ///< by repetition, then by frame that counts
  std::optional<MotionAnswer> motion = {};       ///< of the last repetition
  std::optional<SurfaceAnswer> surface = {};     ///< of the last repetition
};

struct ContestResult {
  std::vector<Entrant> entrants;  ///< ours first in each task
  MotionAnswer standing_still;    ///< what the answer "no motion" would be worth
  std::size_t frames_fused = 0;   ///< by ours, hence by all
  int threads_started = 0;        ///< meanwhile, by any library: everyone was asked for none
};

struct ContestSettings {
  EffectiveConfig config;  ///< of our pipeline
  FieldSettings field;
  int repetitions = 3;
  int threads_before = 1;  ///< of the process, before any library was called
  std::function<void(int repetition, std::size_t frame)> progress = {};
};

/// The first frames start an estimator (ours processes both of them twice): they are run, and do not count.
inline constexpr std::size_t kStartingFrames = 2;

/// Our pipeline goes through the recording once, for the poses that all fusions get. Then, in each
/// repetition, everyone starts anew; each frame is loaded once and handed to one after the other, and who
/// comes first changes from frame to frame. Fusions take the frames that ours fuses. A peer that throws is
/// out. Errors: those of Recording::load_frame and Pipeline::process, and usage if no frame would count or
/// has ground truth.
[[nodiscard]] Result<ContestResult> hold_contest(const Recording& recording, const std::vector<Peer>& peers,
                                                 const ContestSettings& settings);

}  // namespace fusebench::peers
