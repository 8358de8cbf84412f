// Residuals of all patches in one frame, the measurement of the filter. Photometric (Eq. 3) and
// point-to-plane (Eq. 4) residuals of all pixels are whitened, robustly weighted and summed to two 6x6
// information forms. Colour constrains the pose relative to the reference frame, depth the pose relative to
// the model.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/intensity_residual.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/filter/iekf.hpp"
#include "core/estimator/measurement/patch_brightness.hpp"
#include "core/estimator/measurement/patch_outcome.hpp"
#include "core/estimator/measurement/patch_readout.hpp"
#include "core/estimator/measurement/patch_sums.hpp"
#include "core/estimator/measurement/residual_scale.hpp"
#include "core/estimator/patches/patch_deformation.hpp"
#include "core/estimator/patches/patches.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::measurement {

/// The current frame: input of the measurement.
struct ObservedFrame {
  std::span<const GreyImage> pyramid;
  const DepthImage& depth_m;  ///< gated
  bool color_is_new = true;   ///< false: repeated image, no photometric residuals
  bool depth_is_new = true;   ///< false: repeated image, no geometric residuals
  ReadoutMotion motion = {};
};

class PatchMeasurement final : public filter::PoseMeasurement {
 public:
  /// The references must outlive the measurement.
  PatchMeasurement(const config::Config& config, const SensorRig& rig, const Workers& workers);

  /// Sets the frame and reuses the buffers. Call it before the other functions. Frame and patches must
  /// outlive the use of the measurement and stay unchanged.
  void observe(const ObservedFrame& frame, std::span<const patches::Patch> patches,
               const ResidualScale& scale);

  [[nodiscard]] int stages() const override;
  [[nodiscard]] filter::MeasurementQuadratic linearise(const filter::PoseHypothesis& poses, int stage,
                                                       bool gate) override;
  [[nodiscard]] double trial_cost(const filter::PoseHypothesis& poses, const filter::TangentVector& step,
                                  double fraction) override;
  void accept() override;

  /// After the last linearise(): moves each patch by its own translation, from its position at this pose
  /// (terms.patch_motion). Changes only the pixel positions and their visibility.
  void move_patches_alone(const SE3& T_world_imu_predicted);

  /// One outcome for each patch, from the last linearise(), which must have been of the last stage.
  [[nodiscard]] std::span<const PatchOutcome> outcomes() const { return outcomes_; }
  /// False if the frame repeats an earlier colour image.
  [[nodiscard]] bool color_is_new() const { return frame_ && frame_->color_is_new; }
  /// Ratio of the variance of the pose by residuals of one kind to its nominal value (patch_scatter.hpp).
  [[nodiscard]] double photometric_variance() const { return photometric_variance_; }
  /// Information of the pose against the reference frame at the last linearise(), in the tangent of the pose.
  [[nodiscard]] Matrix6d color_information() const;
  [[nodiscard]] double geometric_variance() const { return geometric_variance_; }
  /// Level-0 pixels of the tracked patches at the last linearise(), by patch.
  [[nodiscard]] TrackedPixels tracked_pixels() const;

 private:
  /// Quantities of a patch that are fixed by the last linearisation.
  struct PatchState {
    PatchBrightness brightness;
    filter::PoseQuadratic photometric;
    filter::PoseQuadratic geometric;
    bool counts = false;  ///< has residuals and was not rejected
  };
  /// Quantities of eight pixels that are fixed by the last linearisation.
  struct FixedLanes {
    PlanePairs pairs;
    simd::Int8 photometric{};  ///< pixels with a residual
  };
  struct Level {
    patches::LevelLanes lanes;
    std::vector<FixedLanes> fixed;
    patches::MutualOcclusion occlusion;
  };
  /// A pose hypothesis, for colour at all pyramid levels and for depth.
  struct PosedLevels;
  /// Weights of the residuals of one kind.
  struct Weighting {
    float share = 0;          ///< of one residual in the measurement
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
  const config::PhotometricConfig& photometric_;  ///< part of config_
  const SensorRig& rig_;
  const Workers& workers_;
  std::optional<ObservedFrame> frame_;
  std::span<const patches::Patch> patches_;
  ResidualScale scale_;
  TermWeights weights_;                ///< in the current frame
  std::optional<double> common_gain_;  ///< of the current frame, set by the first linearise()
  BrightnessPrior brightness_prior_;
  Vector3d origin_world_ = Vector3d::Zero();  ///< origin of the lane coordinates
  AssociationGates gates_;
  std::size_t finest_ = 0;  ///< first level of the last linearise()
  std::vector<Level> levels_;
  std::vector<PatchState> states_;
  std::vector<PatchOutcome> outcomes_;
  /// factor on the nominal variance at the last linearise(), as geometric_variance_
  double photometric_variance_ = 1;
  double geometric_variance_ = 1;
};

}  // namespace fusebench::measurement
