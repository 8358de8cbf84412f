#include "tests/bench/peers/contest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "core/config/config.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"
#include "eval/record/record_origin.hpp"
#include "tests/bench/peers/cpu_stopwatch.hpp"
#include "tests/bench/peers/our_pipeline.hpp"
#include "tests/bench/peers/single_thread.hpp"
#include "tests/support/gated_depth.hpp"

namespace fusebench::peers {

using namespace simd;
using namespace config;
using namespace preprocessing;
using namespace recording;
using namespace record;

namespace {

/// What is known of a frame before the contest.
struct PlannedFrame {
  SE3 T_world_camera;
  CameraVelocity velocity;
  bool fused = false;
  std::optional<SE3> true_motion;  ///< T_before_now
};

std::optional<SE3> true_motion(const Recording& recording, std::size_t frame) {
  if (frame == 0) return std::nullopt;
  const auto before = true_camera(recording, recording.frames[frame - 1].capture_ns);
  const auto now = true_camera(recording, recording.frames[frame].capture_ns);
  if (!before || !now) return std::nullopt;
  return before->inverse() * *now;
}

Result<std::vector<PlannedFrame>> plan(const Recording& recording, const Config& config) {
  std::vector<PlannedFrame> frames;
  OurPipeline ours(config, recording);
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const auto frame = recording.load_frame(i);
    if (!frame) return tl::unexpected(frame.error());
    if (const auto done = ours.process(*frame); !done) return tl::unexpected(done.error());
    frames.push_back({ours.T_world_camera(), ours.velocity(), ours.fused(), true_motion(recording, i)});
  }
  return frames;
}

/// What our pipeline does to a frame before it fuses it, so that all fuse the same pixels.
RgbdFrame fusible(const RgbdFrame& frame, const Recording& recording, const Config& config,
                  const CameraVelocity& velocity) {
  RgbdFrame result = frame;
  if (config.terms.motion_compensation && !frame_timing(frame, recording.rig.timing).is_one_instant()) {
    const Workers workers(1);
    const SensorRig& rig = recording.rig;
    compensate_motion(frame, rig.camera, frame_timing(frame, rig.timing), velocity, workers, result);
    compensate_color(frame, rig.camera, frame_timing(frame, rig.timing), velocity, result.depth_m, workers,
                     result.color);
  }
  result.depth_m = testing::gated_depth(result.depth_m, config.depth);
  return result;
}

/// A peer within one repetition.
struct Runner {
  Entrant& entrant;
  std::unique_ptr<Contestant> contestant;
  MotionJudge judge = {};

  /// What the library throws ends it for this peer, not for the others.
  template <class Act>
  void attempt(const Act& act) {
    if (!entrant.missing.empty()) return;
    try {
      act();
    } catch (const std::exception& error) {
      entrant.missing = fmt::format("failed: {}", error.what());
      contestant.reset();
    }
  }
};

/// One repetition: everyone anew.
class Round {
 public:
  Round(const Recording& recording, const std::vector<Peer>& peers, const ContestSettings& settings,
        const std::vector<PlannedFrame>& frames, ContestResult& result)
      : frames_(frames),
        result_(result),
        ours_(settings.config.values(), recording),
        threads_before_(settings.threads_before) {
    for (Entrant& entrant : result.entrants) entrant.cpu_ms.emplace_back();
    for (std::size_t i = 0; i < peers.size(); ++i) {
      Runner& runner = runners_.emplace_back(Runner{result.entrants[kOurs + i], nullptr});
      runner.attempt([&] { runner.contestant = peers[i].make(recording.rig.camera, settings.field); });
    }
  }

  /// Everyone on one frame.
  Result<void> take(std::size_t index, const ContestFrame& frame) {
    const std::size_t turns = runners_.size() + 1;
    for (std::size_t turn = 0; turn < turns; ++turn) {
      const std::size_t who = (index + turn) % turns;
      if (who > 0) {
        take_peer(runners_[who - 1], index, frame);
      } else if (auto done = take_ours(index, frame); !done) {
        return done;
      }
    }
    result_.threads_started = std::max(result_.threads_started, threads_of_process() - threads_before_);
    return {};
  }

  void judge() {
    result_.entrants[0].motion = our_judge_.answer();
    result_.entrants[1].surface = judge_surface(ours_.surface(), ours_.model());
    for (Runner& runner : runners_) {
      if (runner.entrant.task == Task::tracking) runner.entrant.motion = runner.judge.answer();
      if (runner.entrant.task != Task::fusion) continue;
      runner.attempt(
          [&] { runner.entrant.surface = judge_surface(runner.contestant->surface(), ours_.model()); });
    }
  }

  static constexpr std::size_t kOurs = 3;  ///< entrants that are ours: tracking, fusion, whole frames

 private:
  Result<void> take_ours(std::size_t index, const ContestFrame& frame) {
    const auto cost = ours_.process(frame.frame);
    if (!cost) return tl::unexpected(cost.error());
    if (index < kStartingFrames) return {};
    result_.entrants[0].cpu_ms.back().push_back(cost->tracking_ms);
    if (ours_.fused()) result_.entrants[1].cpu_ms.back().push_back(cost->fusion_ms);
    result_.entrants[2].cpu_ms.back().push_back(cost->frame_ms);
    if (frames_[index].true_motion) our_judge_.add(ours_.motion(), *frames_[index].true_motion);
    return {};
  }

  void take_peer(Runner& runner, std::size_t index, const ContestFrame& frame) {
    if (runner.entrant.task == Task::fusion && !frames_[index].fused) return;
    runner.attempt([&] {
      runner.contestant->receive(frame);
      const CpuStopwatch cpu;
      runner.contestant->work();
      const double cpu_ms = cpu.milliseconds();
      if (index < kStartingFrames) return;
      runner.entrant.cpu_ms.back().push_back(cpu_ms);
      if (frames_[index].true_motion)
        runner.judge.add(runner.contestant->motion(), *frames_[index].true_motion);
    });
  }

  const std::vector<PlannedFrame>& frames_;
  ContestResult& result_;
  OurPipeline ours_;
  MotionJudge our_judge_;
  std::vector<Runner> runners_;
  int threads_before_;
};

std::vector<Entrant> entrants_of(const std::vector<Peer>& peers) {
  std::vector<Entrant> entrants = {
      {.name = "FuseBench", .settings = "preprocess, predict, update, refresh", .task = Task::tracking},
      {.name = "FuseBench", .settings = "fuse, with colour", .task = Task::fusion},
      {.name = "FuseBench", .settings = "all of a frame", .task = std::nullopt}};
  for (const Peer& peer : peers) {
    Entrant& entrant = entrants.emplace_back(Entrant{peer.name, peer.settings, peer.package, peer.task});
    if (!peer.make) entrant.missing = fmt::format("not installed (Debian package {})", peer.package);
  }
  return entrants;
}

}  // namespace

Result<ContestResult> hold_contest(const Recording& recording, const std::vector<Peer>& peers,
                                   const ContestSettings& settings) {
  if (recording.frames.size() <= kStartingFrames)
    return fail(ErrorCode::usage,
                fmt::format("{} frames (allowed: more than {})", recording.frames.size(), kStartingFrames));
  const auto frames = plan(recording, settings.config.values());
  if (!frames) return tl::unexpected(frames.error());

  ContestResult result;
  result.entrants = entrants_of(peers);
  result.frames_fused =
      static_cast<std::size_t>(std::ranges::count_if(*frames, [](const auto& frame) { return frame.fused; }));
  MotionJudge standing_still;
  for (std::size_t i = kStartingFrames; i < frames->size(); ++i) {
    if ((*frames)[i].true_motion) standing_still.add(SE3{}, *(*frames)[i].true_motion);
  }
  result.standing_still = standing_still.answer();
  if (result.standing_still.frames == 0)
    return fail(ErrorCode::usage, fmt::format("recording '{}' has no ground truth there", recording.name),
                "answers are checked by it, and a time without a right answer says nothing");

  for (int repetition = 0; repetition < settings.repetitions; ++repetition) {
    Round round(recording, peers, settings, *frames, result);
    for (std::size_t i = 0; i < frames->size(); ++i) {
      auto loaded = recording.load_frame(i);
      if (!loaded) return tl::unexpected(loaded.error());
      const PlannedFrame& planned = (*frames)[i];
      RgbdFrame to_fuse = fusible(*loaded, recording, settings.config.values(), planned.velocity);
      const ContestFrame frame{std::move(*loaded), std::move(to_fuse), planned.T_world_camera};
      if (auto taken = round.take(i, frame); !taken) return tl::unexpected(taken.error());
      if (settings.progress) settings.progress(repetition, i);
    }
    round.judge();
  }
  return result;
}

}  // namespace fusebench::peers
