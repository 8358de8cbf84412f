// The runs of a suite with what their comparison needs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eval/record.hpp"
#include "eval/study/shared_frames.hpp"
#include "eval/study/study_values.hpp"

namespace fusebench {

struct StudyRun {
  std::string recording;
  std::string group;
  std::string half;
  std::string variant;
  std::filesystem::path folder;  ///< empty if there is none
  RunRecord record;
  /// On the pixels shared with the reference variant's run of the recording; empty for the reference itself,
  /// and unless both runs are ok.
  std::vector<SharedFrame> shared = {};
};

struct Study {
  std::vector<StudyRun> runs;
  std::vector<std::string> notes;  ///< what could not be compared, and why
};

/// Reads the differences of all pairs with the reference variant, and the patches' motion.
[[nodiscard]] Study gather_study(std::vector<StudyRun> runs);

/// The run of that variant on the same recording; null if there is none.
[[nodiscard]] const StudyRun* sibling(const Study& study, const StudyRun& run, std::string_view variant);

/// A number of one run, as StudyValue says. On common pixels, a variant is measured on those that it shares
/// with the reference, and the reference on those that it shares with `partner`.
[[nodiscard]] std::optional<double> value_of(const Study& study, const StudyRun& run, const StudyValue& value,
                                             std::string_view partner = "dm");

}  // namespace fusebench
