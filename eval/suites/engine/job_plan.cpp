#include "eval/suites/engine/job_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "eval/record/external/external_program.hpp"
#include "eval/suites/only_filters.hpp"
#include "eval/suites/suite_recordings.hpp"

namespace fusebench::engine {

namespace {

/// The configuration of a variant at a point of the sweep, after --set.
Result<config::EffectiveConfig> config_of(const suites::Suite& suite, const config::Variant& variant,
                                          const std::vector<std::string>& sets,
                                          const suites::SweepPoint& point) {
  auto config = suites::suite_config(suite, variant);
  if (!config) return config;
  for (const std::string& assignment : sets) {
    if (auto set = config->set_assignment(assignment); !set) return tl::unexpected(set.error());
  }
  for (const auto& [key, value] : point) {
    if (auto set = config->set(key, value, "sweep"); !set) return tl::unexpected(set.error());
  }
  return config;
}

using Programs = std::vector<std::shared_ptr<const external::ExternalProgram>>;

/// The external programs of the suite that are wanted, each asked for its version. names: of all of them.
Result<Programs> programs_of(const suites::Suite& suite, const std::vector<std::string>& only,
                             std::vector<std::string>& names) {
  Programs programs;
  for (const std::string& file : suite.systems) {
    auto program = external::read_external_program(file);
    if (!program && program.error().code == ErrorCode::data_missing)
      return fail(ErrorCode::data_missing,
                  fmt::format("suite '{}', systems: {}", suite.name, program.error().message),
                  "paths of systems count from the folder that fusebench is started in");
    if (!program) return tl::unexpected(program.error());
    names.push_back(program->name);
    if (!suites::variant_may_be_wanted(only, program->name)) continue;
    if (auto found = external::find_installed(*program); !found) return tl::unexpected(found.error());
    programs.push_back(std::make_shared<const external::ExternalProgram>(std::move(*program)));
  }
  if (auto known = suites::check_excluded_variants(suite.exclusions, names); !known)
    return tl::unexpected(known.error());
  return programs;
}

/// What all runs of a suite have in common.
struct Common {
  const suites::Suite& suite;
  const BatchOptions& options;
  Programs programs;
  std::vector<std::string> sets;  ///< those that sweep nothing
  std::vector<suites::SweepPoint> points;
};

/// One run, but for its recording's window and its repetition.
Result<BatchJob> job_of(const Common& common, const suites::PlannedRecording& recording,
                        const std::string& variant_name, const suites::SweepPoint& point) {
  const auto variant = config::find_variant(variant_name);
  if (!variant) return tl::unexpected(variant.error());
  auto config = config_of(common.suite, *variant, common.sets, point);
  if (!config) return tl::unexpected(config.error());
  run::RunSpec spec;
  spec.recording = recording.folder;
  spec.imu = common.suite.imu;
  spec.prepare = common.suite.prepare;
  spec.variant = variant_name;
  spec.config = std::move(*config);
  spec.threads = common.options.threads;
  spec.kept = common.suite.kept;
  spec.profile = common.options.profile;
  spec.out = common.options.out;
  const bool optional = common.suite.all && !recording.simulation;
  return BatchJob{recording.folder, variant_name,    std::move(spec),      optional,
                  recording.group,  recording.split, recording.simulation, point};
}

const suites::Exclusion* exclusion_of(const suites::Suite& suite, const BatchJob& job) {
  if (suite.exclusions.empty()) return nullptr;
  const auto rows = config::describe_options(job.spec.config.values());
  const auto found = std::ranges::find_if(suite.exclusions, [&](const suites::Exclusion& exclusion) {
    return exclusion.covers(job.recording.filename().string(), job.variant, rows);
  });
  return found == suite.exclusions.end() ? nullptr : &*found;
}

/// One run of an external program, but for its window and its repetition.
Result<BatchJob> job_of_program(const Common& common, const suites::PlannedRecording& recording,
                                const std::shared_ptr<const external::ExternalProgram>& program) {
  // Of the configuration it is the evaluation that counts.
  auto config = suites::suite_config(common.suite, config::all_variants().front());
  if (!config) return tl::unexpected(config.error());
  run::RunSpec spec;
  spec.config = std::move(*config);
  spec.recording = recording.folder;
  spec.imu = common.suite.imu;
  spec.variant = program->name;
  spec.program = program;
  spec.threads = common.options.threads;
  spec.kept = common.suite.kept;
  spec.out = common.options.out;
  const bool optional = common.suite.all && !recording.simulation;
  return BatchJob{recording.folder, program->name,   std::move(spec),      optional,
                  recording.group,  recording.split, recording.simulation, {}};
}

/// The runs of external programs over one recording; those that cannot run here are excluded.
Result<void> add_program_runs(const Common& common, const suites::PlannedRecording& recording,
                              BatchPlan& plan, std::set<const suites::Exclusion*>& met,
                              std::vector<BatchJob>& jobs) {
  for (const auto& program : common.programs) {
    if (!suites::wanted(common.options.only, recording.folder.filename().string(), recording.split,
                        program->name))
      continue;
    auto job = job_of_program(common, recording, program);
    if (!job) return tl::unexpected(job.error());
    const suites::Exclusion* const exclusion = exclusion_of(common.suite, *job);
    if (exclusion != nullptr) met.insert(exclusion);
    if (exclusion != nullptr || !program->absent.empty()) {
      plan.excluded.push_back({to_string(*job), exclusion != nullptr ? exclusion->reason : program->absent});
    } else {
      jobs.push_back(std::move(*job));
    }
  }
  return {};
}

/// Of two values of one option it would be a matter of order which counts.
Result<void> check_swept_once(const std::vector<suites::SweepBlock>& blocks,
                              const std::vector<std::string>& sets) {
  std::set<std::string> keys;
  const auto twice = [](const std::string& place, const std::string& key) {
    return fail(ErrorCode::configuration, fmt::format("{}: {} is swept as well", place, key),
                "take it out of the [[sweep]], or leave --set away");
  };
  for (const suites::SweepBlock& block : blocks) {
    for (const suites::SweepAxis& axis : block.axes) {
      if (!keys.insert(axis.key).second) return twice(axis.place, axis.key);
    }
  }
  for (const std::string& set : sets) {
    const std::string key = set.substr(0, set.find('='));
    if (keys.contains(key)) return twice("--set " + set, key);
  }
  return {};
}

/// All runs over one recording, once each.
Result<void> add_runs(const Common& common, const suites::PlannedRecording& recording, BatchPlan& plan,
                      std::set<const suites::Exclusion*>& met, std::vector<BatchJob>& jobs) {
  for (const std::string& variant : recording.variants) {
    if (!suites::wanted(common.options.only, recording.folder.filename().string(), recording.split, variant))
      continue;
    for (const suites::SweepPoint& point : common.points) {
      auto job = job_of(common, recording, variant, point);
      if (!job) return tl::unexpected(job.error());
      if (const suites::Exclusion* exclusion = exclusion_of(common.suite, *job)) {
        met.insert(exclusion);
        plan.excluded.push_back({to_string(*job), exclusion->reason});
        continue;
      }
      if (auto related = config::check_relations(job->spec.config.values()); !related) {
        const Error& error = related.error();
        if (point.empty()) return related;
        return fail(error.code, fmt::format("{}: {}", to_string(*job), error.message),
                    "[[exclude]] with these options and a reason leaves the point out");
      }
      jobs.push_back(std::move(*job));
    }
  }
  return {};
}

/// Before the runs are made: each holds its whole configuration.
Result<void> check_count(const Common& common, const std::vector<suites::PlannedRecording>& recordings) {
  const suites::Suite& suite = common.suite;
  const auto many = [](std::size_t count) { return static_cast<double>(count); };
  double runs = 0;
  for (const suites::PlannedRecording& recording : recordings) {
    const auto wanted_variants = std::ranges::count_if(recording.variants, [&](const std::string& variant) {
      return suites::variant_may_be_wanted(common.options.only, variant);
    });
    runs += static_cast<double>(wanted_variants) * many(common.points.size()) + many(common.programs.size());
  }
  runs *= many(std::max<std::size_t>(1, suite.windows.size())) * static_cast<double>(suite.repetitions) *
          static_cast<double>(suite.replicates);
  if (runs <= many(suites::kMostRuns)) return {};
  return fail(
      ErrorCode::configuration,
      fmt::format("suite '{}' has {:.0f} runs (allowed: up to {})", suite.name, runs, suites::kMostRuns),
      "take fewer points, windows, variants, repetitions or replicates, or a part of it at a time (--only)");
}

bool takes_seed(const external::ExternalProgram& program) {
  return std::ranges::any_of(program.command, [](const std::string& argument) {
    return argument.find("{seed}") != std::string::npos;
  });
}

/// Whether replicates of a run differ: all systems of this program begin at the pose that they are given; an
/// external program has to take a seed.
bool has_replicates(const BatchJob& job) { return !job.spec.program || takes_seed(*job.spec.program); }

/// In the order of the plan: windows, then repetitions, then replicates, then the runs.
void multiply(const Common& common, const std::vector<BatchJob>& jobs, BatchPlan& plan) {
  const suites::Suite& suite = common.suite;
  std::vector<std::optional<run::FrameWindow>> windows(suite.windows.begin(), suite.windows.end());
  if (windows.empty()) windows.emplace_back();
  int most = suite.repetitions;
  for (const auto& program : common.programs) most = std::max(most, program->repetitions);
  const auto repetitions = [&](const BatchJob& job) {
    return job.spec.program ? std::max(suite.repetitions, job.spec.program->repetitions) : suite.repetitions;
  };
  for (const auto& window : windows) {
    for (int repetition = 1; repetition <= most; ++repetition) {
      for (int replicate = 0; replicate < suite.replicates; ++replicate) {
        for (const BatchJob& job : jobs) {
          if (repetition > repetitions(job) || (replicate > 0 && !has_replicates(job))) continue;
          plan.jobs.push_back(job);
          plan.jobs.back().spec.frames = window;
          plan.jobs.back().spec.repetition = repetition;
          plan.jobs.back().spec.replicate = replicate;
        }
      }
    }
  }
}

/// A filter that no run meets, since other filters leave out all that it would keep.
void warn_of_idle_filters(const std::vector<std::string>& only, BatchPlan& plan) {
  if (plan.jobs.empty() || !plan.excluded.empty() || !plan.absent.empty()) return;
  for (const std::string& filter : only) {
    if (std::ranges::any_of(plan.jobs, [&](const BatchJob& job) {
          return suites::wanted({filter}, job.recording.filename().string(), job.split, job.variant);
        }))
      continue;
    plan.warnings.push_back(
        fmt::format("--only {}: no run meets it together with the other filters", filter));
  }
}

}  // namespace

std::string to_string(const BatchJob& job) {
  std::string text = fmt::format("{} {}", job.recording.filename().string(), job.variant);
  if (!job.edits.empty()) text += fmt::format(" {}", suites::to_string(job.edits));
  if (job.spec.frames) text += fmt::format(" frames {}", run::to_string(*job.spec.frames));
  if (job.spec.repetition > 1) text += fmt::format(" repetition {}", job.spec.repetition);
  if (job.spec.replicate > 0) text += fmt::format(" replicate {}", job.spec.replicate);
  return text;
}

Result<BatchPlan> plan_batch(const suites::Suite& suite, const BatchOptions& options) {
  // A mistyped filter is said before a recording that is not there.
  if (auto known = suites::check_filters(options.only); !known) return tl::unexpected(known.error());
  std::vector<std::string> names = suites::variants_of(suite);
  auto programs = programs_of(suite, options.only, names);
  if (!programs) return tl::unexpected(programs.error());
  if (auto known = suites::check_variants(options.only, suite.name, names); !known)
    return tl::unexpected(known.error());
  Common common{suite, options, std::move(*programs), options.sets, {}};
  std::vector<suites::SweepBlock> blocks = suite.sweeps;
  auto swept = suites::take_swept_sets(common.sets);
  if (!swept) return tl::unexpected(swept.error());
  if (*swept) blocks.push_back(std::move(**swept));
  if (auto once = check_swept_once(blocks, common.sets); !once) return tl::unexpected(once.error());
  auto points = suites::sweep_points(blocks);
  if (!points) return tl::unexpected(points.error());
  common.points = std::move(*points);

  const auto recordings = suites::planned_recordings(suite, {options.data, options.simulated, options.only});
  if (!recordings) return tl::unexpected(recordings.error());
  if (auto few = check_count(common, recordings->present); !few) return tl::unexpected(few.error());
  BatchPlan plan;
  plan.absent = recordings->absent;
  for (const auto& program : common.programs) {
    if (!program->absent.empty()) plan.absent.push_back(program->name + ": " + program->absent);
  }
  std::set<const suites::Exclusion*> met;
  for (const suites::PlannedRecording& recording : recordings->present) {
    std::vector<BatchJob> jobs;
    if (auto added = add_runs(common, recording, plan, met, jobs); !added)
      return tl::unexpected(added.error());
    if (auto added = add_program_runs(common, recording, plan, met, jobs); !added)
      return tl::unexpected(added.error());
    multiply(common, jobs, plan);
  }
  warn_of_idle_filters(options.only, plan);
  std::set<std::string> unused;
  if (suite.replicates > 1) {
    for (const auto& program : common.programs)
      if (program->absent.empty() && !takes_seed(*program))
        plan.warnings.push_back(
            fmt::format("{}: its command takes no {{seed}}: one run in place of {} replicates", program->name,
                        suite.replicates));
  }
  for (const BatchJob& job : plan.jobs) {
    if (job.spec.program) continue;
    if (const auto sentence = run::options_without_effect(job.spec.config))
      unused.insert(fmt::format("variant '{}': {}", job.variant, *sentence));
  }
  plan.warnings.insert(plan.warnings.end(), unused.begin(), unused.end());
  for (const suites::Exclusion& exclusion : suite.exclusions) {
    if (!met.contains(&exclusion) && options.only.empty())
      plan.warnings.push_back(
          fmt::format("{}: the exclusion '{}' meets no run", exclusion.place, exclusion.reason));
  }
  if (plan.jobs.empty() && plan.excluded.empty()) {
    return fail(ErrorCode::usage, fmt::format("--only leaves nothing of suite '{}'", suite.name),
                "recording=TEXT keeps the recordings whose name contains it, variant=NAME one variant, "
                "split=held-out or tuning one split");
  }
  return plan;
}

}  // namespace fusebench::engine
