// The runs of a suite with what their comparison needs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eval/compare/study/shared_frames.hpp"
#include "eval/record/record.hpp"
#include "eval/record/registry/run_metric.hpp"

namespace fusebench::study {

struct StudyRun {
  std::string recording;
  std::string group;
  std::string split;
  std::string variant;
  std::filesystem::path folder;  ///< empty if there is none
  record::RunRecord record;
  /// On the pixels shared with the reference variant's run of the recording; empty for the reference itself,
  /// and unless both runs are ok.
  std::vector<SharedFrame> shared = {};
};

struct Study {
  /// The variant that AIE on common pixels is measured against, and whose frames say how far patches moved.
  [[nodiscard]] const std::string& reference() const { return variants.front(); }
  /// The variant that the reference is next to where no other one is requested; empty if there is none.
  [[nodiscard]] std::string partner() const { return variants.size() > 1 ? variants[1] : std::string(); }

  std::vector<std::string> variants;  ///< as the suite names them: the reference, its partner, and more
  std::vector<StudyRun> runs;
  std::vector<std::string> notes;  ///< what could not be compared, and why
};

/// Reads the differences of all pairs with the reference variant, and the patches' motion.
/// variants: as the suite names them, one at least.
[[nodiscard]] Study gather_study(std::vector<StudyRun> runs, std::vector<std::string> variants);

/// The run of that variant on the same recording; null if there is none.
[[nodiscard]] const StudyRun* sibling(const Study& study, const StudyRun& run, std::string_view variant);

/// A number of one run, of the registry. On common pixels, a variant is measured on those that it shares
/// with the reference, and the reference on those that it shares with `partner`; empty: with the
/// study's partner.
[[nodiscard]] std::optional<double> value_of(const Study& study, const StudyRun& run,
                                             const registry::RunMetric& metric,
                                             std::string_view partner = {});

}  // namespace fusebench::study
