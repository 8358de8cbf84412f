// How long the stages of a frame took, and when each of them was at work.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <string_view>

namespace fusebench::health {

/// Stages whose time is reported.
enum class Stage { preprocess, predict, update, fuse, refresh };
inline constexpr std::array<std::string_view, 5> kStageNames = {"preprocess", "predict", "update", "fuse",
                                                                "refresh"};

/// By the clock of the process: only differences mean something.
struct TimeSpan {
  std::chrono::steady_clock::time_point begin;
  std::chrono::steady_clock::time_point end;

  [[nodiscard]] double milliseconds() const {
    return std::chrono::duration<double, std::milli>(end - begin).count();
  }
};

/// One stretch of work of a stage.
struct StageSpan {
  Stage stage = Stage::preprocess;
  TimeSpan time;
};

/// The stretches of one frame's work, which never overlap, in order. A stage may have several. Of fixed size,
/// so that no frame allocates anything for it.
class StageTimes {
 public:
  /// A frame that is found again has ten, and the second frame of a recording, with which the first one may
  /// be done again, three times as many. What has no room is in the sums alone.
  static constexpr std::size_t kMostSpans = 32;

  void add(const StageSpan& span) {
    sums_ms_[static_cast<std::size_t>(span.stage)] += span.time.milliseconds();
    if (count_ < kMostSpans) spans_[count_++] = span;
  }

  /// Those of work on the same frame that came after.
  void add(const StageTimes& later) {
    for (const StageSpan& span : later.spans()) {
      if (count_ < kMostSpans) spans_[count_++] = span;
    }
    for (std::size_t stage = 0; stage < sums_ms_.size(); ++stage) sums_ms_[stage] += later.sums_ms_[stage];
  }

  [[nodiscard]] std::span<const StageSpan> spans() const { return {spans_.data(), count_}; }

  /// Milliseconds by stage; 0 of a stage that the frame did without.
  [[nodiscard]] const std::array<double, kStageNames.size()>& sums_ms() const { return sums_ms_; }

 private:
  std::array<StageSpan, kMostSpans> spans_{};
  std::size_t count_ = 0;
  std::array<double, kStageNames.size()> sums_ms_{};
};

/// Adds the time since its construction to one stage.
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
