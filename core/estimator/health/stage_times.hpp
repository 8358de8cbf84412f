// Durations and time spans of the stages of a frame.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <string_view>

namespace fusebench::health {

/// Stages with reported times.
enum class Stage { preprocess, predict, update, fuse, refresh };
inline constexpr std::array<std::string_view, 5> kStageNames = {"preprocess", "predict", "update", "fuse",
                                                                "refresh"};

/// Steady clock: only differences are meaningful.
struct TimeSpan {
  std::chrono::steady_clock::time_point begin;
  std::chrono::steady_clock::time_point end;

  [[nodiscard]] double milliseconds() const {
    return std::chrono::duration<double, std::milli>(end - begin).count();
  }
};

/// One time span of a stage.
struct StageSpan {
  Stage stage = Stage::preprocess;
  TimeSpan time;
};

/// The time spans of one frame, in order and without overlap. A stage may have several. Fixed size, so no
/// frame allocates memory.
class StageTimes {
 public:
  /// A relocalised frame has ten spans; the second frame of a recording, after which the first may be
  /// processed again, three times as many. Further spans count in the sums only.
  static constexpr std::size_t kMostSpans = 32;

  void add(const StageSpan& span) {
    sums_ms_[static_cast<std::size_t>(span.stage)] += span.time.milliseconds();
    if (count_ < kMostSpans) spans_[count_++] = span;
  }

  /// Appends the spans of later work on the same frame.
  void add(const StageTimes& later) {
    for (const StageSpan& span : later.spans()) {
      if (count_ < kMostSpans) spans_[count_++] = span;
    }
    for (std::size_t stage = 0; stage < sums_ms_.size(); ++stage) sums_ms_[stage] += later.sums_ms_[stage];
  }

  [[nodiscard]] std::span<const StageSpan> spans() const { return {spans_.data(), count_}; }

  /// Milliseconds by stage; 0 for a stage that did not run.
  [[nodiscard]] const std::array<double, kStageNames.size()>& sums_ms() const { return sums_ms_; }

 private:
  std::array<StageSpan, kMostSpans> spans_{};
  std::size_t count_ = 0;
  std::array<double, kStageNames.size()> sums_ms_{};
};

/// Adds its own lifetime to one stage.
class StageClock {
 public:
  StageClock(StageTimes& times, Stage stage)
      : times_(times), stage_(stage), begin_(std::chrono::steady_clock::now()) {}
  ~StageClock() { times_.add({stage_, {begin_, std::chrono::steady_clock::now()}}); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  StageTimes& times_;
  Stage stage_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace fusebench::health
