// Folders of thousands of runs: reading the records, and the long table of all their numbers.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config/config_access.hpp"
#include "eval/compare/aggregate/long_table.hpp"
#include "eval/compare/aggregate/run_rows.hpp"
#include "eval/record/record.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace config;
using namespace metrics;
using namespace trajectory_error;
using namespace record;
using namespace aggregate;

namespace {

constexpr std::size_t kRuns = 2'000;

template <class Distances>
void fill(Distances& distances, double scale_m) {
  distances.stats = statistics(std::vector<double>{scale_m, 2.1 * scale_m, 3.3 * scale_m});
}

/// With all blocks that a run of a simulated recording has, and every option.
RunRecord full_record() {
  RunRecord record;
  record.status = RunStatus::ok;
  record.reason.clear();
  record.recording.notes.assign(4, "a note on what was done to the data on reading, as long as they are");
  record.config_hash = "0011223344556677";
  for (const OptionRow& option : describe_options(EffectiveConfig{}.values()))
    record.config.push_back({option.key, parse_option_value(option.value), "default"});
  record.metrics.ate = {AteResult{}, {}};
  fill(*record.metrics.ate.value, 0.01);
  RpeResult rpe;
  rpe.translation = rpe.rotation = record.metrics.ate.value->stats;
  record.metrics.rpe_frame = record.metrics.rpe_second = {rpe, {}};
  IntensityResult aie;
  fill(aie.all, 3);
  fill(aie.accepted, 2.7);
  record.metrics.aie = {aie, {}};
  RecordedMesh mesh;
  fill(mesh.poses.accuracy, 0.002);
  fill(mesh.poses.completeness, 0.005);
  mesh.poses.thresholds.assign(4, {0.01, 0.9123456789, 0.8123456789, 0.8612345678});
  mesh.first_camera = mesh.poses;
  mesh.positions = mesh.poses;
  record.metrics.mesh = {mesh, {}};
  for (std::size_t i = 0; i < kStateParts.size(); ++i) {
    record.metrics.nees[i] = {NeesResult{}, {}};
    record.metrics.nees[i].value->part = kStateParts[i];
  }
  record.metrics.residuals = {ResidualSummary{}, {}};
  record.frames = {240, 240, 0};
  record.timing = {12.3, 23.4, 400'000'000, 19.5, {{"decode", 3.1}, {"update", 20.2}, {"fuse", 7.3}}};
  return record;
}

/// Written once for all benchmarks of this file; goes with the program.
const std::filesystem::path& folder_of_runs() {
  static const testing::TemporaryFolder folder;
  static const bool written = [] {
    RunRecord record = full_record();
    RecordedOption& swept = record.config.front();
    swept.origin = "--set";
    for (std::size_t i = 0; i < kRuns; ++i) {
      record.recording.name = fmt::format("recording_{}", i % 10);
      record.variant = i % 2 == 0 ? "full" : "dm";
      swept.value = static_cast<std::int64_t>(i / 20);
      folder.write(fmt::format("{}/{}/{:08x}/record.json", record.recording.name, record.variant, i),
                   to_json(record));
    }
    return true;
  }();
  static_cast<void>(written);
  return folder.path();
}

void reading_of_records(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const auto rows = read_run_rows(folder_of_runs(), workers);
  if (!rows || rows->size() != kRuns || unreadable_count(*rows) != 0)
    return state.SkipWithError("not all of the runs were read");
  for (auto _ : state) benchmark::DoNotOptimize(read_run_rows(folder_of_runs(), workers));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRuns));
}

void long_table_of_runs(benchmark::State& state) {
  const auto rows = read_run_rows(folder_of_runs(), Workers(1));
  if (!rows || rows->size() != kRuns) return state.SkipWithError("not all of the runs were read");
  const LongTableRequest request{state.range(0) == 0 ? LongFormat::csv : LongFormat::json_lines, false};
  for (auto _ : state) benchmark::DoNotOptimize(long_table(*rows, request));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kRuns));
}

BENCHMARK(reading_of_records)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(long_table_of_runs)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fusebench
