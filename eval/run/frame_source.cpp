#include "eval/run/frame_source.hpp"

#include <chrono>
#include <utility>

namespace fusebench::run {

FrameSource::FrameSource(const recording::Recording& recording, bool read_ahead)
    : recording_(recording), policy_(read_ahead ? std::launch::async : std::launch::deferred) {
  start_next();
}

void FrameSource::start_next() {
  if (following_ >= recording_.frames.size()) return;
  pending_ = std::async(policy_, [this, frame = following_++]() -> Result<LoadedFrame> {
    const auto begin = std::chrono::steady_clock::now();
    auto loaded = recording_.load_frame(frame);
    if (!loaded) return tl::unexpected(loaded.error());
    return LoadedFrame{std::move(*loaded), {begin, std::chrono::steady_clock::now()}};
  });
}

Result<LoadedFrame> FrameSource::next() {
  check(pending_.valid(), "no frames are left");
  Result<LoadedFrame> frame = pending_.get();
  start_next();
  return frame;
}

}  // namespace fusebench::run
