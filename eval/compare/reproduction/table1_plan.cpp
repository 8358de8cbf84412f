#include "eval/compare/reproduction/table1_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::reproduction {

namespace {

namespace fs = std::filesystem;

/// The suite in which recordings that neither exist nor can be simulated have a source, so that a plan leaves
/// them out; `absent` lists these with their reasons.
suites::Suite available(const suites::Suite& recordings, const engine::BatchOptions& options,
                        std::vector<std::string>& absent) {
  suites::Suite suite = recordings;
  for (suites::SuiteRecording& recording : suite.recordings) {
    if (suites::find_recordings(recording.name, options.data)) continue;
    absent.push_back(recording.name);
    recording.source = "put it under --data";
  }
  std::erase_if(suite.simulations, [&](const suites::SuiteSimulation& simulation) {
    const fs::path& path = simulation.request.trajectory;
    std::error_code ignored;
    if (path.empty() || fs::is_regular_file(options.data / path, ignored)) return false;
    const std::string reason = fmt::format("{} (needs {})", simulation.group, path.string());
    if (std::ranges::find(absent, reason) == absent.end()) absent.push_back(reason);
    suite.recordings.push_back({.name = simulation.name,
                                .group = simulation.group,
                                .source = fmt::format("put {} under --data", path.string())});
    return true;
  });
  return suite;
}

/// Jobs of one variant with these edits.
Result<engine::BatchPlan> plan_side(const suites::Suite& recordings, const std::string& variant,
                                    engine::BatchOptions options, const std::vector<std::string>& edits) {
  suites::Suite suite = recordings;
  suite.variants = {variant};
  for (suites::SuiteSimulation& simulation : suite.simulations) simulation.variants = {variant};
  for (suites::SuiteRecording& recording : suite.recordings) recording.variants.clear();
  options.sets.insert(options.sets.end(), edits.begin(), edits.end());
  auto plan = engine::plan_batch(suite, options);
  if (!plan) return plan;
  for (engine::BatchJob& job : plan->jobs) {  // by which its name differs from those of other readings
    for (const std::string& edit : edits) {
      const std::size_t equals = edit.find('=');
      job.edits.emplace_back(edit.substr(0, equals), edit.substr(equals + 1));
    }
  }
  return plan;
}

/// Jobs without those that are there already, by what they are.
class UniqueJobs {
 public:
  /// The number of the job.
  std::size_t add(engine::BatchJob job) {
    const std::string key = fmt::format("{} {} {}", job.recording.string(), job.variant,
                                        config::config_hash(job.spec.config.values()));
    const auto [place, is_new] = numbers_.emplace(key, jobs.size());
    if (is_new) jobs.push_back(std::move(job));
    return place->second;
  }

  std::vector<engine::BatchJob> jobs;

 private:
  std::map<std::string, std::size_t> numbers_;
};

Result<void> check_names(const Table1Protocol& protocol, const std::vector<std::string>& names) {
  std::vector<std::string_view> known;
  for (const Reading& reading : protocol.readings) known.push_back(reading.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end()) continue;
    return fail(ErrorCode::usage, fmt::format("no reading '{}'{}", name, nearest_hint(name, known)),
                fmt::format("readings are: {}", fmt::join(known, "; ")));
  }
  return {};
}

/// Jobs in the order of their recordings; the comparisons follow.
void sort_by_recording(Table1Plan& plan) {
  std::vector<std::size_t> order(plan.jobs.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::vector<fs::path> recordings;
  const auto rank = [&](std::size_t job) {
    const fs::path& recording = plan.jobs[job].recording;
    return std::ranges::find(recordings, recording) - recordings.begin();
  };
  for (const engine::BatchJob& job : plan.jobs) {
    if (std::ranges::find(recordings, job.recording) == recordings.end()) recordings.push_back(job.recording);
  }
  std::ranges::stable_sort(order, {}, rank);
  std::vector<std::size_t> place(order.size());
  std::vector<engine::BatchJob> jobs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    jobs.push_back(std::move(plan.jobs[order[i]]));
  }
  plan.jobs = std::move(jobs);
  for (ComparedRuns& runs : plan.compared) {
    runs.dm = place[runs.dm];
    runs.ours = place[runs.ours];
  }
}

}  // namespace

Result<Table1Plan> plan_table1(const Table1Protocol& protocol, const suites::Suite& recordings,
                               const engine::BatchOptions& options, const Table1Extent& extent) {
  if (auto known = check_names(protocol, extent.readings); !known) return tl::unexpected(known.error());
  Table1Plan plan;
  const suites::Suite suite = available(recordings, options, plan.absent);
  UniqueJobs unique;
  for (std::size_t r = 0; r < protocol.readings.size(); ++r) {
    const Reading& reading = protocol.readings[r];
    if (!extent.readings.empty() && std::ranges::find(extent.readings, reading.name) == extent.readings.end())
      continue;
    std::vector<std::string> dm_edits = reading.set;
    dm_edits.insert(dm_edits.end(), reading.set_dm.begin(), reading.set_dm.end());
    auto dm = plan_side(suite, reading.dm, options, dm_edits);
    if (!dm) return tl::unexpected(dm.error());
    auto ours = plan_side(suite, reading.ours, options, reading.set);
    if (!ours) return tl::unexpected(ours.error());
    check(dm->jobs.size() == ours->jobs.size(), "both methods of a reading run over the same recordings");
    std::set<std::string> groups;
    for (std::size_t i = 0; i < dm->jobs.size(); ++i) {
      const bool first = groups.insert(dm->jobs[i].group).second;
      if (reading.factorial && !first && !extent.factorial_everywhere) continue;
      ComparedRuns& runs = plan.compared.emplace_back();
      runs.reading = r;
      runs.group = dm->jobs[i].group;
      runs.recording = dm->jobs[i].recording.filename().string();
      runs.dm = unique.add(std::move(dm->jobs[i]));
      runs.ours = unique.add(std::move(ours->jobs[i]));
    }
  }
  plan.jobs = std::move(unique.jobs);
  sort_by_recording(plan);
  return plan;
}

}  // namespace fusebench::reproduction
