// fusebench_bench: see --help, which is Google Benchmark's.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdio>
#include <opencv2/core/utility.hpp>
#include <string>

#include "eval/record/build_info.hpp"
#include "tests/bench/scene_kinds.hpp"

int main(int argc, char** argv) {
  // What has no threads of ours has none of OpenCV's either, as `workers` says.
  cv::setNumThreads(1);
  const fusebench::record::BuildInfo& build = fusebench::record::build_info();
  benchmark::AddCustomContext("compiler", std::string(build.compiler));
  benchmark::AddCustomContext("flags", std::string(build.flags));
  if (const auto folder = fusebench::testing::recorded_folder(); !folder)
    fmt::print(stderr, "Without real frames (scene:1): {}.\n", folder.error().message);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
