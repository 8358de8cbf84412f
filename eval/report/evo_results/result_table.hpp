// Several results side by side, as evo_res has them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/report/evo_results/evo_result.hpp"

namespace fusebench::evo_results {

/// A result with the name that it has in tables.
struct LabelledResult {
  std::string label;
  EvoResult result;
};

struct ResultChoice {
  bool use_filenames = false;  ///< labels are the archives; else the estimates' file names
  bool ignore_title = false;   ///< other metrics and other alignments may stand side by side
  bool merge = false;  ///< into one: statistics averaged; errors too if there are as many, else joined
};

/// Reads archives. Errors: those of read_result(); usage for two with one label, or titles that differ.
[[nodiscard]] Result<std::vector<LabelledResult>> load_results(
    const std::vector<std::filesystem::path>& files, const ResultChoice& choice);

/// A line of statistics for each result. At least one.
[[nodiscard]] std::string to_text(const std::vector<LabelledResult>& results, bool with_title);
/// As evo_res --save_table: a nameless first column of labels; max, mean, median, min, rmse, sse, std.
/// Numbers with their shortest round trip.
[[nodiscard]] std::string to_csv(const std::vector<LabelledResult>& results);
/// [{"label", "title", "reference", "estimate", "errors": how many, "stats": {...}}].
[[nodiscard]] std::string to_json(const std::vector<LabelledResult>& results);

}  // namespace fusebench::evo_results
