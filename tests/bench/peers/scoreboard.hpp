// The result of a contest as a table and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/peers/contest.hpp"

namespace fusebench::peers {

/// What all lines of a table have in common.
struct ContestConditions {
  std::string recording;
  std::string frames;    ///< "0 to 99"
  std::string imu;       ///< "recorded", "synthetic IMU, made from the ground truth"
  std::string imu_note;  ///< how
  int width_px = 0;
  int height_px = 0;
  FieldSettings field;
  int repetitions = 0;
  std::string cpu;
  std::string build;  ///< of ours: compiler and flags
};

/// Times of one entrant, milliseconds of CPU per frame, over all repetitions.
struct Score {
  double median_ms = 0;
  double p90_ms = 0;
  double mean_ms = 0;
  double spread = 0;            ///< of the repetitions' medians: (largest - smallest) / median
  std::optional<double> ratio;  ///< to the median of ours at the same task; nothing if its answers are wrong
  std::vector<double> repetition_medians_ms;
};
/// Nothing if there are no times.
[[nodiscard]] std::optional<Score> score_of(const Entrant& entrant, const ContestResult& result);

/// A sentence with the conditions, then one line for each entrant.
[[nodiscard]] std::string scoreboard_text(const ContestResult& result, const ContestConditions& conditions);

/// The same, and the time of each frame.
[[nodiscard]] std::string scoreboard_json(const ContestResult& result, const ContestConditions& conditions);

}  // namespace fusebench::peers
