// Kernels of the estimator and the evaluation, each run in a window of its own, in which callgrind counts
// instructions. Outside of valgrind they just run and are checked.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/scene_kinds.hpp"

namespace fusebench::perf {

/// What was counted, and how much work it was.
struct CountedKernel {
  std::string name;
  std::size_t items = 0;
  std::string item;  ///< what there are so many of: "pixel", "triangle"
};

class KernelCounts {
 public:
  /// Runs the kernel once to fill the memory that it uses again and checks its answer, then once more in a
  /// window that callgrind reports by this name, and checks that answer. items_if_right: how many items the
  /// last run worked on; throws (check()) if its answer is wrong. An answer without items is wrong as well.
  /// One run is enough: the same instructions run every time.
  void count(std::string_view name, std::string_view item, const std::function<void()>& kernel,
             const std::function<std::size_t()>& items_if_right);

  [[nodiscard]] const std::vector<CountedKernel>& counted() const { return counted_; }

 private:
  std::vector<CountedKernel> counted_;
};

/// From files and sensors to what the tracker wants: decoding, motion compensation, pyramid, depth gate.
void count_frame_kernels(KernelCounts& counts, const testing::BenchScene& scene);
/// Fusion, ray casting, meshing.
void count_model_kernels(KernelCounts& counts, const testing::BenchScene& scene);
/// Patches, the filter's update, and the whole of a frame.
void count_tracking_kernels(KernelCounts& counts, const testing::BenchScene& scene);
/// Errors of trajectories and meshes.
void count_evaluation_kernels(KernelCounts& counts);
/// An image of each camera of a simulated recording.
void count_simulator_kernels(KernelCounts& counts);

}  // namespace fusebench::perf
