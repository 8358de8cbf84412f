// Two folders of runs against each other: what got worse, what got better, and where it began.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/divergence.hpp"
#include "eval/compare/gates.hpp"
#include "eval/compare/run_pairs.hpp"

namespace fusebench::compare {

/// In the order in which people read them.
enum class GateVerdict {
  regression,
  changed,      ///< beyond the tolerance, of a number without a better direction; fails
  improvement,  ///< beyond the tolerance: the baseline is out of date
  suspect,      ///< slower or larger, but measured once: a rerun decides
  note,         ///< said, never failing
  unchanged,
};
[[nodiscard]] std::string_view to_string(GateVerdict verdict);  ///< "REGRESSION", "note"

/// One gate of one pair of runs.
struct GateResult {
  std::string gate;  ///< "run", "data", "status", "repetitions", "config", "trajectory", or a metric's key
  GateVerdict verdict = GateVerdict::unchanged;
  bool fails = false;
  std::string message;  ///< one sentence, with numbers and units; empty if unchanged
  std::string unit = {};
  std::optional<double> base = {};   ///< of times: the median
  std::optional<double> fresh = {};  ///< of NEW
  std::optional<double> p = {};      ///< of the rank test, if it was made
  std::string not_gated = {};        ///< of times: why they decide nothing; else empty
  /// In `unit`: |fresh - base| up to this passes; of times (factor - 1) * base. Absent without a base.
  std::optional<double> tolerance = {};
  std::optional<registry::Better> better = {};  ///< of numbers
};

[[nodiscard]] GateResult regression(std::string gate, std::string message);  ///< fails
[[nodiscard]] GateResult note(std::string gate, std::string message);        ///< does not fail

/// What a regression that was intended asks for.
inline constexpr const char* kUpdate = "take NEW as the next BASE (docs/ci.md)";

struct ComparedRun {
  RunPair runs;
  std::vector<GateResult> gates;
  std::optional<Divergence> divergence;
  bool is_identical = false;  ///< both have a trajectory, and it is the same
};

struct RunComparison {
  std::vector<ComparedRun> runs;
  std::vector<std::string> notes;  ///< of no single run

  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::size_t count(GateVerdict verdict) const;  ///< gates
  [[nodiscard]] std::size_t failures() const;                  ///< gates
  [[nodiscard]] std::size_t identical() const;                 ///< runs
  /// Runs that diverge, the earliest frame first.
  [[nodiscard]] std::vector<const ComparedRun*> diverging() const;
};

/// Deterministic numbers are taken from the first run of each side; where both sides have enough replicates,
/// numbers are compared by their ranges. `confirming` are the runs of a rerun of NEW (empty: none was made):
/// a time or a size that failed is a regression only if it fails there as well, against the same baseline. A
/// trajectory without a recorded hash whose rows cannot be read is a regression with that reason. Differences
/// of ignored options are a note (gate "options"); a key that no run knows is a note, too. Error
/// data_corrupt, with the file, if a run of any of the three is not whole or its trajectory is not the one
/// that it wrote.
[[nodiscard]] Result<RunComparison> compare_runs(std::vector<run_files::FoundRun> base,
                                                 std::vector<run_files::FoundRun> fresh, const Gates& gates,
                                                 const std::vector<run_files::FoundRun>& confirming = {},
                                                 const IgnoredOptions& ignored = {});

/// The gate of a number, unchanged, with all that is known of it before it is judged.
[[nodiscard]] GateResult number_gate(const registry::RunMetric& metric, const MetricTolerance& tolerance,
                                     std::optional<double> base, std::optional<double> fresh);

/// Sets verdict and fails of a gate of which both numbers are known and further apart than its tolerance.
void judge_change(GateResult& gate, const Gates& gates);

/// Whether both sides have so many replicates (Gates::min_repetitions) that their distributions can be
/// compared.
[[nodiscard]] bool has_replicates_to_gate(const RunPair& pair, const Gates& gates);

/// The gates of numbers of a pair with replicates, or with runs of a program that does not repeat exactly,
/// see replicate_gates.cpp: in place of those of single runs. Without has_replicates_to_gate() none of them
/// fails.
[[nodiscard]] std::vector<GateResult> replicate_gates(const RunPair& pair, const Gates& gates);

/// The gates of the configurations of a pair, see config_gates.cpp.
[[nodiscard]] std::vector<GateResult> config_gates(const record::RunRecord& base,
                                                   const record::RunRecord& fresh, const Gates& gates,
                                                   const IgnoredOptions& ignored);

/// The gates of times and memory of a pair, see timed_gates.cpp. confirming: runs of the same experiment.
[[nodiscard]] std::vector<GateResult> timed_gates(const RunPair& pair, const Gates& gates,
                                                  std::span<const run_files::FoundRun> confirming,
                                                  bool confirmation_given);

}  // namespace fusebench::compare
