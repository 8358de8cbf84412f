// The summary of a study's runs: by split, group and variant, against the motion in the image, and
// criterion by criterion.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/compare/study/criteria_check.hpp"
#include "eval/compare/study/study.hpp"
#include "eval/metrics/nees_metrics.hpp"

namespace fusebench::study {

/// One number over the recordings of a row.
struct ValueSpread {
  std::size_t count = 0;  ///< runs that have it; the numbers below are 0 without any
  double mean = 0;
  double median = 0;
  double worst = 0;
  std::string worst_recording;
  std::optional<metrics::NeesBounds> bounds_95;  ///< of the mean over so many runs, for NEES
  /// On common pixels: with which variant they are shared, and its mean on the same pixels.
  std::string partner;
  double partner_mean = 0;
};

struct SummaryRow {
  std::string split;
  std::string group;
  std::string variant;
  std::size_t total = 0;
  std::size_t ok = 0;
  std::size_t lost = 0;  ///< runs; total - ok - lost failed
  std::size_t lost_frames = 0;
  std::size_t frames = 0;
  std::vector<ValueSpread> values;  ///< in the order of the study's columns
};

/// Edges of the bins of image motion, px between two frames; the last bin is open.
inline constexpr std::array<double, 6> kMotionEdges_px = {0, 2, 5, 10, 20, 30};

/// AIE on the pixels that the reference and its partner (Study) share, where patches moved that far.
struct MotionBin {
  double from_px = 0;
  double to_px = std::numeric_limits<double>::infinity();
  SharedMeans means;  ///< of the partner
};
struct MotionCurve {
  std::string split;
  std::string group;  ///< "all": of all groups
  std::vector<MotionBin> bins;
};

struct StudySummary {
  std::string suite;
  std::string reference;  ///< these two variants as Study says; curves compare them
  std::string partner;
  std::vector<SummaryRow> rows;  ///< held-out split first; groups as the suite has them; variants as listed
  std::vector<MotionCurve> curves;
  std::vector<CriterionResult> criteria;
  std::vector<std::string> notes;  ///< where the data of which groups come from; what was not compared
};

inline constexpr std::string_view kAllGroups = "all";

[[nodiscard]] StudySummary summarise(const std::string& suite, const Study& study,
                                     std::span<const suites::Criterion> criteria);

}  // namespace fusebench::study
