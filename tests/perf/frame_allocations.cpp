// Counts what a frame takes from the heap once the pipeline has run in: the allocator of the C library, by
// which every other one gets its memory, is replaced by one that counts and hands on.
#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <opencv2/core/utility.hpp>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "core/recording_estimator.hpp"
#include "tests/support/simulated_frames.hpp"

// glibc's own names of what is replaced here.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

struct Allocations {
  std::atomic<std::size_t> count{0};
  std::atomic<std::size_t> of_image_size{0};  ///< a byte a pixel or more

  void add(std::size_t size) {
    constexpr std::size_t kPixels = 320 * 240;
    ++count;
    if (size >= kPixels) ++of_image_size;
  }
};

/// Before main() as well, when nothing is constructed yet.
constinit Allocations allocations;

}  // namespace

extern "C" {
void* malloc(std::size_t size) {
  allocations.add(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  allocations.add(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  allocations.add(size);
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  allocations.add(size);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  allocations.add(size);
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}

namespace fusebench::perf {

using namespace config;
using namespace health;
using namespace core;

namespace {

// Bounds of the median, once the first frames have made room: a frame takes memory for what it is reported
// by, for the matrices of an update, for a window of the field, and for what OpenCV finds corners with.
constexpr std::size_t kMostAllocations = 130;
constexpr std::size_t kMostOfImageSize = 5;
constexpr std::size_t kFrames = 60;
constexpr std::size_t kWarmUp = 30;

std::size_t median(std::vector<std::size_t> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// 0 if half of the frames take no more than the bounds; those that become keyframes take more.
int count_of_frames() {
  const testing::SimulatedRun run = testing::simulate(kFrames);
  const Workers workers(1);
  RecordingEstimator pipeline(EffectiveConfig{}.values(), run.rig, run.imu, workers);
  std::vector<std::size_t> counts;
  std::vector<std::size_t> counts_of_image_size;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    const std::size_t count = allocations.count;
    const std::size_t of_image_size = allocations.of_image_size;
    const Result<FrameReport> report = pipeline.process(run.frames[k]);
    check(report.has_value() && report->status != FrameStatus::lost, "the frame is tracked");
    if (k < kWarmUp) continue;
    counts.push_back(allocations.count - count);
    counts_of_image_size.push_back(allocations.of_image_size - of_image_size);
  }
  fmt::print(
      "frames {} to {} take memory from the heap {} times in the median (allowed: {}), {} times as much as "
      "an "
      "image or more (allowed: {})\n",
      kWarmUp, kFrames - 1, median(counts), kMostAllocations, median(counts_of_image_size), kMostOfImageSize);
  return median(counts) <= kMostAllocations && median(counts_of_image_size) <= kMostOfImageSize ? 0 : 1;
}

}  // namespace
}  // namespace fusebench::perf

int main() {
  cv::setNumThreads(1);
  return fusebench::perf::count_of_frames();
}
