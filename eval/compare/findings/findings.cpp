#include "eval/compare/findings/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "eval/metrics/statistics.hpp"
#include "eval/record/record.hpp"

namespace fusebench::findings {

namespace {

constexpr std::size_t kMostNamed = 6;

/// "a, b and 3 more".
std::string list_of(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamed); ++i)
    text += (i > 0 ? between : "") + names[i];
  if (names.size() > kMostNamed) text += fmt::format(" and {} more", names.size() - kMostNamed);
  return text;
}

std::string counted(std::size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// "ATE" of "ATE [cm]", and "cm".
std::pair<std::string, std::string> name_and_unit(const registry::RunMetric& metric) {
  const std::string heading(metric.heading);
  const std::size_t open = heading.find(" [");
  if (open == std::string::npos) return {heading, ""};
  return {heading.substr(0, open), " " + heading.substr(open + 2, heading.size() - open - 3)};
}

std::string shown(const registry::RunMetric& metric, double value) {
  return registry::shown_text(metric, value) + name_and_unit(metric).second;
}

/// "1.15 times the best of each recording (95 % interval 1.05 to 1.30)".
std::string ratio_text(const aggregate::RatioMean& mean) {
  std::string text = fmt::format("{:.2f} times the best of each recording", *mean.ratio);
  if (mean.interval)
    text += fmt::format(" (95 % interval {:.2f} to {:.2f})", (*mean.interval)[0], (*mean.interval)[1]);
  return text;
}

/// What the order is worth, of configurations that do not tie.
std::string evidence_of(const Ranking& ranking) {
  constexpr std::size_t kFewest = 3;  // of two, the bootstrap has three different samples
  if (ranking.recordings == 1) return " One recording: no evidence that the order is the same on others.";
  if (ranking.recordings < kFewest)
    return fmt::format(" {} are too few to tell it from the differences between recordings.",
                       counted(ranking.recordings, "recording"));
  std::string text = " Recordings and replicates drawn by chance do not explain the difference.";
  if (ranking.configurations.size() > 2)
    text += fmt::format(" Not corrected for picking the best of {}.", ranking.configurations.size());
  return text;
}

/// Its label with the reasons why its number does not compare: "full (20 % of its frames tracked)".
std::string named(const RankedConfiguration& configuration, const Ranking& ranking) {
  std::string caveats;
  const bool sparse = std::ranges::any_of(ranking.configurations, [&](const RankedConfiguration& other) {
    return configuration.tracked_share() < tables::kLeastCoverage * other.tracked_share();
  });
  if (sparse) caveats = fmt::format("{:.0f} % of its frames tracked", 100 * configuration.tracked_share());
  if (configuration.contradicts_truth)
    caveats += fmt::format("{}its poses contradict the ground truth", caveats.empty() ? "" : ", ");
  return caveats.empty() ? configuration.label : fmt::format("{} ({})", configuration.label, caveats);
}

/// best: of the ranking, which others tie with.
std::string tie_sentence(const Ranking& ranking, const std::string& name, const std::string& where) {
  const RankedConfiguration& best = ranking.configurations.front();
  std::vector<std::string> tied;
  for (const RankedConfiguration& configuration : ranking.configurations) {
    if (!configuration.mean.tied) continue;
    std::string text = named(configuration, ranking);
    if (configuration.value) text += " " + shown(*ranking.metric, *configuration.value);
    tied.push_back(fmt::format("{}, {}", text, ratio_text(configuration.mean)));
  }
  return fmt::format("A tie for the smallest {} on {}: {}. {}", name, where, list_of(tied, "; "),
                     best.mean.interval
                         ? "The 95 % intervals of the ratios between them contain 1 (bootstrap over "
                           "recordings and replicates)."
                         : "Their numbers are equal.");
}

std::string best_sentence(const Ranking& ranking) {
  const RankedConfiguration& best = ranking.configurations.front();
  const std::string name = name_and_unit(*ranking.metric).first;
  std::string where = ranking.recordings == 1
                          ? fmt::format("one {} recording", ranking.data_word())
                          : fmt::format("{} {} recordings", ranking.recordings, ranking.data_word());
  where += ranking.restrictions();
  if (!best.value) {
    return fmt::format("No configuration has an {} on all of {}; {} has it on most, {}.", name, where,
                       named(best, ranking), best.recordings);
  }
  const std::string number = shown(*ranking.metric, *best.value) +
                             (ranking.recordings > 1 ? " (geometric mean over recordings)" : "");
  if (ranking.configurations.size() == 1) {
    return fmt::format("{} has an {} of {} on {}. There is nothing to compare it with.", named(best, ranking),
                       name, number, where);
  }
  const RankedConfiguration& second = ranking.configurations[1];
  if (second.mean.tied) return tie_sentence(ranking, name, where);
  if (!second.value) {
    return fmt::format("{} alone has an {} on all of {}: {}. Next is {}, which has it on {}.",
                       named(best, ranking), name, where, number, named(second, ranking), second.recordings);
  }
  return fmt::format("{} has the smallest {} on {}: {}, {}. Next is {} with {}, {}.{}", named(best, ranking),
                     name, where, number, ratio_text(best.mean), named(second, ranking),
                     shown(*ranking.metric, *second.value), ratio_text(second.mean), evidence_of(ranking));
}

/// Beyond, the error of the rest is no longer that of the recording.
constexpr double kTellingLostShare = 0.05;

double lost_share(const tables::TableRow& row) {
  if (row.total == 0) return 0;
  return 1 - static_cast<double>(row.tracked) / static_cast<double>(row.total);
}

/// Without repetitions, in their order.
void add_once(std::vector<std::string>& list, const std::string& text) {
  if (!text.empty() && std::ranges::find(list, text) == list.end()) list.push_back(text);
}

}  // namespace

std::optional<std::string> sentence_of(const Ranking& ranking) {
  if (ranking.configurations.empty() || ranking.recordings == 0) return std::nullopt;
  return best_sentence(ranking);
}

std::optional<std::string> final_poses_of(std::span<const run_files::FoundRun> runs) {
  std::vector<double> online_m, final_m;
  for (const run_files::FoundRun& run : runs) {
    if (run.state != run_files::RunState::whole || !run.record.final_metrics) continue;
    const auto& online = run.record.metrics.ate.value;
    const auto& final = run.record.final_metrics->ate.value;
    if (!online || !final) continue;
    online_m.push_back(online->stats.rmse);
    final_m.push_back(final->stats.rmse);
  }
  if (final_m.empty()) return std::nullopt;
  if (final_m.size() == 1)
    return fmt::format("With loops closed, final poses have an ATE of {:.2f} cm, and online poses {:.2f} cm.",
                       100 * final_m.front(), 100 * online_m.front());
  std::size_t smaller = 0;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < final_m.size(); ++i) {
    smaller += final_m[i] < online_m[i] ? 1U : 0U;
    ratios.push_back(final_m[i] / online_m[i]);
  }
  return fmt::format(
      "With loops closed, final poses have a smaller ATE than online poses in {} of {} runs; the median "
      "ratio "
      "is {:.2f}.",
      smaller, final_m.size(), metrics::statistics(ratios).median);
}

std::vector<std::string> failures_of(const tables::ResultTable& table) {
  std::vector<std::string> bad;
  std::vector<std::string> silent;
  std::vector<std::string> lost;
  for (const tables::TableRow& row : table.rows) {
    if (row.status != record::RunStatus::ok) {
      bad.push_back(fmt::format("{} on {} ({}: {})", row.label, row.recording, record::to_string(row.status),
                                row.reason));
      continue;
    }
    if (row.silent.value_or(0) > 0)
      silent.push_back(fmt::format("{} on {} ({})", row.label, row.recording, counted(*row.silent, "frame")));
    if (const double share = lost_share(row); share >= kTellingLostShare)
      lost.push_back(fmt::format("{} on {} ({:.0f} %)", row.label, row.recording, 100 * share));
  }
  std::vector<std::string> sentences;
  if (bad.empty()) {
    sentences.push_back(table.rows.size() == 1 ? "The run ended well." : "All runs ended well.");
  } else {
    sentences.push_back(fmt::format("{} of {} did not end well: {}.", bad.size(),
                                    counted(table.rows.size(), "run"), list_of(bad, "; ")));
  }
  if (!silent.empty()) {
    sentences.push_back(fmt::format(
        "Undetected failures (poses that are wrong and not reported as lost) in {} that ended well: {}.",
        counted(silent.size(), "run"), list_of(silent, "; ")));
  }
  if (!lost.empty()) {
    sentences.push_back(
        fmt::format("Frames without a pose, which an ATE excludes: {}.", list_of(lost, "; ")));
  }
  return sentences;
}

std::string origin_of(std::span<const run_files::FoundRun> runs) {
  std::vector<std::string> programs;
  std::vector<std::string> machines;
  for (const run_files::FoundRun& run : runs) {
    const record::RecordedProvenance& p = run.record.provenance;
    if (run.state == run_files::RunState::whole && !p.version.empty()) {
      add_once(programs, fmt::format("fusebench {}{}", p.version, p.git.empty() ? "" : " (" + p.git + ")"));
      add_once(machines, fmt::format("{}{} ({})", p.host.empty() ? "" : p.host + ", ", p.cpu,
                                     counted(static_cast<std::size_t>(std::max(p.threads, 0)), "thread")));
    }
  }
  if (programs.empty()) return "The records do not name the program that made these runs.";
  return fmt::format("Made by {} on {}.", list_of(programs, ", "), list_of(machines, "; "));
}

}  // namespace fusebench::findings
