// Ways in which a recording may have been misread, tried against the pairs of frames that its ground truth
// warps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.hpp"
#include "datasets/inspection/measures/frame_warp.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::inspection {

/// How the pairs fit under one reading, compared with another.
struct Comparison {
  double factor = 1;  ///< geometric mean over pairs of the ratios of depth and intensity residuals; of
                      ///< intensity alone where the reading leaves depth as it is
  double wins = 0;    ///< share of pairs with a ratio below 1
};

/// Loaded pairs of a recording with what is needed to warp them.
class WarpTest {
 public:
  WarpTest(const recording::Recording& recording, std::vector<measures::WarpPair> pairs,
           const Workers& workers);

  [[nodiscard]] const std::vector<measures::WarpPair>& pairs() const { return pairs_; }
  [[nodiscard]] std::vector<std::optional<measures::WarpResidual>> residuals(
      const measures::Reading& reading) const;
  [[nodiscard]] Comparison compare(const std::vector<std::optional<measures::WarpResidual>>& base,
                                   const measures::Reading& reading) const;
  /// The same, of every third pair if the reading does not lower their residuals: most readings are wrong.
  [[nodiscard]] Comparison screen(const std::vector<std::optional<measures::WarpResidual>>& base,
                                  const measures::Reading& reading) const;

 private:
  [[nodiscard]] Comparison compare_every(std::size_t step,
                                         const std::vector<std::optional<measures::WarpResidual>>& base,
                                         const measures::Reading& reading) const;
  [[nodiscard]] std::optional<double> ratio_of(const measures::WarpPair& pair,
                                               const measures::WarpResidual& base,
                                               const measures::Reading& reading) const;

  const recording::Recording& recording_;
  std::vector<measures::WarpPair> pairs_;
  std::int64_t gap_ns_;
  const Workers& workers_;
};

/// A discrete misreading.
struct Misreading {
  std::string code;    ///< of its finding; several of one code are a family, of which the best is reported
  std::string name;    ///< as rows of reports have it
  std::string reason;  ///< what is wrong, and what corrects it: "the poses are ...: inverting them"
  std::string hint;
  std::function<void(measures::Reading&)> apply;
  /// Of many alternatives one may be better by chance where the poses explain nothing: it must also be
  /// clearly better than no motion at all.
  bool must_beat_still = true;
};
/// Simple ones first.
[[nodiscard]] std::vector<Misreading> misreadings(const PinholeCamera& camera);

/// A parameter that was fitted: its best value and how well it fits.
struct FittedParameter {
  double value = 0;
  Comparison comparison;
};
[[nodiscard]] FittedParameter fit_depth_scale(const WarpTest& test,
                                              const measures::Reading& base);  ///< factor, 1/8 to 8
[[nodiscard]] FittedParameter fit_focal_scale(const WarpTest& test,
                                              const measures::Reading& base);  ///< factor, 0.7 to 1.4
[[nodiscard]] FittedParameter fit_image_scale(const WarpTest& test,
                                              const measures::Reading& base);  ///< factor, 0.2 to 5
[[nodiscard]] FittedParameter fit_truth_shift(const WarpTest& test,
                                              const measures::Reading& base);  ///< s, up to 1
[[nodiscard]] FittedParameter fit_depth_shift(const WarpTest& test,
                                              const measures::Reading& base);  ///< s, up to 1

}  // namespace fusebench::inspection
