// Direct alignment of whole small images with a reference frame, level by level (Steinbruecker, Sturm and
// Cremers 2011; Kerl et al. 2013), as a measurement of the filter. It only provides a start for the patches
// within their basin of convergence. Its information is not used in the update.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/alignment/reference_points.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/measurement/patch_brightness.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::alignment {

class ImageAlignment final : public filter::PoseMeasurement {
 public:
  /// The references must outlive it.
  ImageAlignment(const config::AlignmentConfig& alignment, const config::PhotometricConfig& photometric,
                 const SensorRig& rig);

  /// pyramid: of the frame to align; the views must stay valid.
  void observe(std::span<const GreyImage> pyramid, const ReferencePoints& reference,
               const SE3& T_world_reference, int coarsest_level);

  [[nodiscard]] int stages() const override { return coarsest_ - reference_->finest_level() + 1; }
  [[nodiscard]] filter::MeasurementQuadratic linearise(const filter::PoseHypothesis& poses, int stage,
                                                       bool gate) override;
  [[nodiscard]] double trial_cost(const filter::PoseHypothesis& poses, const filter::TangentVector& step,
                                  double fraction) override;
  void accept() override { light_.value = light_.trial; }

  /// Share of the points of the last level that were in the image at the last linearisation.
  [[nodiscard]] double seen_share() const;

 private:
  [[nodiscard]] patches::PosedCamera posed(const filter::PoseHypothesis& poses) const;

  const config::AlignmentConfig& alignment_;
  const config::PhotometricConfig& photometric_;
  const SensorRig& rig_;
  measurement::BrightnessPrior brightness_prior_;
  measurement::PatchBrightness light_;
  std::span<const GreyImage> pyramid_;
  const ReferencePoints* reference_ = nullptr;
  SE3 T_world_reference_;
  int coarsest_ = 0;
  int level_ = 0;
  std::vector<char> used_;  ///< points that were in the image at the last linearisation
};

}  // namespace fusebench::alignment
