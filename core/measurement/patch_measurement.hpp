// The measurement of the filter: all patches against one frame. Stacks the photometric (Eq. 3) and
// point-to-plane (Eq. 4) residuals of all pixels of all patches, whitened and robustly weighted, and reduces
// them to two 6x6 information forms: colour constrains the pose relative to the reference frame, depth the
// pose relative to the model.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/intensity_residual.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/iekf.hpp"
#include "core/measurement/patch_brightness.hpp"
#include "core/measurement/patch_outcome.hpp"
#include "core/measurement/patch_readout.hpp"
#include "core/measurement/patch_sums.hpp"
#include "core/measurement/residual_scale.hpp"
#include "core/patches/patch_deformation.hpp"
#include "core/patches/patches.hpp"
#include "core/patches/posed_camera.hpp"

namespace fusebench::measurement {

/// The current frame: input of the measurement.
struct ObservedFrame {
  std::span<const GreyImage> pyramid;
  const DepthImage& depth_m;  ///< gated
  bool color_is_new = true;   ///< otherwise it says nothing of this instant: no photometric residuals
  bool depth_is_new = true;   ///< otherwise no geometric ones
  ReadoutMotion motion = {};
};

class PatchMeasurement final : public filter::PoseMeasurement {
 public:
  /// All references must outlive the measurement.
  PatchMeasurement(const config::Config& config, const SensorRig& rig, const Workers& workers);

  /// Sets the frame, reusing the buffers of the one before; must be called before all else. Frame and patches
  /// must outlive the use of the measurement, unchanged.
  void observe(const ObservedFrame& frame, std::span<const patches::Patch> patches,
               const ResidualScale& scale);

  [[nodiscard]] int stages() const override;
  [[nodiscard]] filter::MeasurementQuadratic linearise(const filter::PoseHypothesis& poses, int stage,
                                                       bool gate) override;
  [[nodiscard]] double trial_cost(const filter::PoseHypothesis& poses, const filter::TangentVector& step,
                                  double fraction) override;
  void accept() override;

  /// After the last linearise(): finds each patch by a translation of its own, from where this pose puts it
  /// (terms.patch_motion). Changes where its pixels are and what is seen of it, and nothing else.
  void move_patches_alone(const SE3& T_world_imu_predicted);

  /// One outcome a patch, from the last linearise() (which must have been of the last stage).
  [[nodiscard]] std::span<const PatchOutcome> outcomes() const { return outcomes_; }
  /// False where the frame repeats an earlier colour image.
  [[nodiscard]] bool color_is_new() const { return frame_ && frame_->color_is_new; }
  /// Ratios of the variance of what residuals of a kind say of the pose to the nominal one there
  /// (patch_scatter.hpp).
  [[nodiscard]] double photometric_variance() const { return photometric_variance_; }
  /// Of the pose against the reference frame, by the last linearise(): tangent of the pose (6x6).
  [[nodiscard]] Matrix6d color_information() const;
  [[nodiscard]] double geometric_variance() const { return geometric_variance_; }
  /// The level-0 pixels of tracked patches there, by patch.
  [[nodiscard]] TrackedPixels tracked_pixels() const;

 private:
  /// Everything that the last linearisation fixed for one patch.
  struct PatchState {
    PatchBrightness brightness;
    filter::PoseQuadratic photometric;
    filter::PoseQuadratic geometric;
    bool counts = false;  ///< has residuals, and was not rejected
  };
  /// What the last linearisation fixed for eight pixels.
  struct FixedLanes {
    PlanePairs pairs;
    simd::Int8 photometric{};  ///< pixels with a residual
  };
  struct Level {
    patches::LevelLanes lanes;
    std::vector<FixedLanes> fixed;
    patches::MutualOcclusion occlusion;
  };
  /// The hypothesis for colour at all pyramid levels, and for depth.
  struct PosedLevels;
  /// How residuals of one kind are weighted.
  struct Weighting {
    float share = 0;          ///< of a pixel's residual in one measurement
    float robust_sigmas = 0;  ///< Huber's k
  };

  void warp_all(const PosedLevels& posed);
  void find_common_gain();
  [[nodiscard]] std::optional<PatchRows> rows_of(std::size_t patch, const patches::PosedCamera& camera) const;
  void judge(std::size_t patch, bool gate);
  void associate_planes(std::size_t patch, const PosedLevels& posed);
  void sum_photometric(std::size_t patch, const PosedLevels& posed);
  void sum_geometric(std::size_t patch, const PosedLevels& posed);
  [[nodiscard]] Weighting photometric_weighting() const;
  [[nodiscard]] Weighting geometric_weighting() const;
  [[nodiscard]] double color_variance() const;
  [[nodiscard]] double measured_variance(filter::PoseQuadratic PatchState::*kind) const;
  [[nodiscard]] double common_depth_variance() const;
  [[nodiscard]] double patch_cost(std::size_t patch, const PosedLevels& posed) const;
  [[nodiscard]] double photometric_cost(std::size_t patch, const PosedLevels& posed) const;
  [[nodiscard]] double geometric_cost(std::size_t patch, const PosedLevels& posed) const;

  const config::Config& config_;
  const config::PhotometricConfig& photometric_;  ///< of config_
  const SensorRig& rig_;
  const Workers& workers_;
  std::optional<ObservedFrame> frame_;
  std::span<const patches::Patch> patches_;
  ResidualScale scale_;
  TermWeights weights_;                ///< in this frame
  std::optional<double> common_gain_;  ///< of this frame, from the first linearise() on
  BrightnessPrior brightness_prior_;
  Vector3d origin_world_ = Vector3d::Zero();  ///< of the lanes' coordinates
  AssociationGates gates_;
  std::size_t finest_ = 0;  ///< level that the last linearise() began with
  std::vector<Level> levels_;
  std::vector<PatchState> states_;
  std::vector<PatchOutcome> outcomes_;
  double photometric_variance_ = 1;  ///< these two: factors on the nominal variance, by the last linearise()
  double geometric_variance_ = 1;
};

}  // namespace fusebench::measurement
