#include "eval/run/preparation/preparation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/run/preparation/moving_frame.hpp"
#include "eval/run/preparation/sensor_timing.hpp"

namespace fusebench::preparation {

namespace {

constexpr std::size_t kWindowFrames = 120;
constexpr std::size_t kMostWindows = 5;
constexpr std::size_t kFewestFrames = 30;  // fewer give too few pairs
constexpr double kOpenShare = 0.7;    // a measurement that is wider, relative to an unknown one, says nothing
constexpr double kContradicting = 3;  // standard deviations

constexpr std::array<std::string_view, 3> kNames = {"color_readout", "depth_readout", "depth_delay"};
constexpr std::array<std::string_view, 3> kTitles = {"read-out of colour", "read-out of depth",
                                                     "delay of depth"};

/// Parts of equal length, spread evenly; a short recording as a whole.
Result<std::vector<MovingFrames>> load_windows(const recording::Recording& recording, const Workers& workers,
                                               const std::atomic<bool>* stop) {
  const std::size_t frames = recording.frames.size();
  const std::size_t count =
      std::clamp<std::size_t>((frames + kWindowFrames - 1) / kWindowFrames, 1, kMostWindows);
  const std::size_t length = std::min(frames, kWindowFrames);
  std::vector<MovingFrames> windows;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = count == 1 ? 0 : (frames - length) * i / (count - 1);
    auto window = moving_frames(recording, begin, begin + length, workers, stop);
    if (!window) return tl::unexpected(window.error());
    windows.push_back(*std::move(window));
  }
  return windows;
}

/// Whether nobody has said it (kUnknownTiming).
bool is_unknown(const TimingEstimate& prior, int i) {
  const TimingEstimate unknown = timing_of(calibration::kUnknownTiming);
  return prior.value_s[i] == unknown.value_s[i] && prior.sigma_s[i] == unknown.sigma_s[i];
}

/// The images alone tell what is not held; what the calibration says decides afterwards.
SensorTiming without_prior(TimingEstimate told) {
  constexpr double kNoPrior_s = 0.1;
  for (int i = 0; i < 3; ++i) {
    if (told.sigma_s[i] > 0) told.sigma_s[i] = kNoPrior_s;
  }
  return sensor_timing(told);
}

/// Of a constant that the images tell.
Verdict verdict_of(const PreparedConstant& constant, bool unknown) {
  if (unknown)
    return constant.measured_sigma_s <= kOpenShare * constant.before_sigma_s ? Verdict::measured
                                                                             : Verdict::open;
  const double sigma_s = std::hypot(constant.measured_sigma_s, constant.before_sigma_s);
  const double apart_s = std::abs(constant.measured_s - constant.before_s);
  return apart_s > kContradicting * sigma_s ? Verdict::measured : Verdict::agrees;
}

PreparedConstant constant_of(const TimingEstimate& prior, const MeasuredTiming& timing, int i) {
  PreparedConstant constant{.name = kNames[static_cast<std::size_t>(i)],
                            .before_s = prior.value_s[i],
                            .before_sigma_s = prior.sigma_s[i],
                            .after_s = prior.value_s[i],
                            .after_sigma_s = prior.sigma_s[i]};
  if (!(prior.sigma_s[i] > 0)) return constant;
  constant.verdict = Verdict::open;
  if (timing.pairs == 0) return constant;
  constant.measured_s = timing.posterior.value_s[i];
  constant.measured_sigma_s = timing.posterior.sigma_s[i];
  constant.verdict = verdict_of(constant, is_unknown(prior, i));
  if (constant.verdict == Verdict::measured) {
    const bool is_readout = i < 2;
    constant.after_s = is_readout ? std::max(0.0, constant.measured_s) : constant.measured_s;
    constant.after_sigma_s = constant.measured_sigma_s;
  }
  return constant;
}

std::string change_text(std::size_t i, const TimingEstimate& before, const TimingEstimate& after) {
  const auto at = static_cast<Eigen::Index>(i);
  return fmt::format("{}{} {:.1f} +- {:.1f} ms, measured in the recording (before: {:.1f} +- {:.1f} ms)",
                     kPreparedNote, kTitles[i], 1e3 * after.value_s[at], 1e3 * after.sigma_s[at],
                     1e3 * before.value_s[at], 1e3 * before.sigma_s[at]);
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::held:
      return "held";
    case Verdict::measured:
      return "measured";
    case Verdict::agrees:
      return "agrees";
    case Verdict::open:
      break;
  }
  return "open";
}

bool is_long_enough(const recording::Recording& recording) {
  return recording.frames.size() >= kFewestFrames;
}

bool can_be_prepared(const recording::Recording& recording) {
  return is_long_enough(recording) && (timing_of(recording.rig.timing).sigma_s.array() > 0).any();
}

Result<Preparation> prepare(const recording::Recording& recording, const Workers& workers,
                            const std::atomic<bool>* stop) {
  const TimingEstimate prior = timing_of(recording.rig.timing);
  MeasuredTiming timing{prior, 0};
  Preparation result;
  if (can_be_prepared(recording)) {
    const auto windows = load_windows(recording, workers, stop);
    if (!windows) return tl::unexpected(windows.error());
    for (const MovingFrames& window : *windows) {
      result.frames += window.frames.size();
      result.tracked += static_cast<std::size_t>(std::ranges::count_if(
          window.frames, [](const MovingFrame& moving) { return moving.motion.has_value(); }));
    }
    timing = measure_timing(*windows, without_prior(prior), recording.rig.camera.fx_px, workers);
  }
  result.pairs = timing.pairs;
  for (int i = 0; i < 3; ++i) result.constants[static_cast<std::size_t>(i)] = constant_of(prior, timing, i);
  return result;
}

SensorTiming timing_after(const Preparation& preparation) {
  TimingEstimate after;
  for (std::size_t i = 0; i < preparation.constants.size(); ++i) {
    after.value_s[static_cast<Eigen::Index>(i)] = preparation.constants[i].after_s;
    after.sigma_s[static_cast<Eigen::Index>(i)] = preparation.constants[i].after_sigma_s;
  }
  return sensor_timing(after);
}

recording::Recording with_timing(recording::Recording recording, const SensorTiming& timing) {
  const TimingEstimate before = timing_of(recording.rig.timing), after = timing_of(timing);
  for (std::size_t i = 0; i < kTitles.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (before.value_s[at] != after.value_s[at] || before.sigma_s[at] != after.sigma_s[at])
      recording.notes.push_back(change_text(i, before, after));
  }
  recording::set_timing(recording, timing);
  return recording;
}

calibration::RigCalibration rig_with_timing(const recording::Recording& recording,
                                            const SensorTiming& timing) {
  check(recording.calibration.has_value(), "the recording's reader kept its calibration");
  calibration::RigCalibration rig = *recording.calibration;
  rig.color.timing = timing;
  rig.source = fmt::format("timing by fusebench prepare on {}; the rest: {}", recording.name,
                           rig.source.empty() ? "no source given" : rig.source);
  return rig;
}

}  // namespace fusebench::preparation
