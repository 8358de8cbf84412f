// fusebench_kernel_counts: what scripts/check_instructions.sh runs under callgrind. Prints
// "kernel,items,item" for each kernel, in the order of callgrind's dumps. Exit code 1 if an answer is wrong.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <opencv2/core/utility.hpp>
#include <string_view>

#include "eval/record/build_info.hpp"
#include "tests/bench/scene_kinds.hpp"
#include "tests/perf/kernel_counts.hpp"

namespace {

constexpr int kWidth_px = 320;

/// What counts depend on, as far as the program knows.
void print_build() {
  const fusebench::record::BuildInfo& build = fusebench::record::build_info();
  fmt::print("compiler: {}\nflags: {}\n", build.compiler, build.flags);
}

void print_counted() {
  // OpenCV would take as many threads as there are cores, and who does what would change from run to run.
  cv::setNumThreads(1);
  fusebench::perf::KernelCounts counts;
  using fusebench::testing::SceneKind;
  const fusebench::testing::BenchScene& scene = fusebench::testing::bench_scene(SceneKind::room, kWidth_px);
  count_frame_kernels(counts, scene);
  count_model_kernels(counts, scene);
  count_tracking_kernels(counts, scene);
  count_evaluation_kernels(counts);
  count_simulator_kernels(counts);
  for (const auto& kernel : counts.counted())
    fmt::print("{},{},{}\n", kernel.name, kernel.items, kernel.item);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2 || (argc == 2 && std::string_view(argv[1]) != "--build")) {
    fmt::print(stderr,
               "Usage: fusebench_kernel_counts [--build]   (--build: compiler and flags, then stop)\n");
    return 2;
  }
  try {
    argc == 2 ? print_build() : print_counted();
  } catch (const std::exception& error) {
    fmt::print(stderr, "kernel_counts: {}\n", error.what());
    return 1;
  }
  return 0;
}
