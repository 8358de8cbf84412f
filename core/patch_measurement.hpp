// The measurement of the filter: all patches against one frame. Stacks the photometric (Eq. 3) and
// point-to-plane (Eq. 4) residuals of all pixels of all patches, whitened and robustly weighted, and reduces
// them to two 6x6 information forms: colour tells the pose against the reference frame, depth against the
// model.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/config.hpp"
#include "core/iekf.hpp"
#include "core/intensity_residual.hpp"
#include "core/parallel.hpp"
#include "core/patch_deformation.hpp"
#include "core/patch_sums.hpp"
#include "core/patches.hpp"
#include "core/residual_scale.hpp"
#include "core/types.hpp"

namespace fusebench {

/// The current frame as the measurement sees it.
struct ObservedFrame {
  std::span<const GreyImage> pyramid;
  const DepthImage& depth_m;  ///< gated
};

/// What became of one patch at the last linearisation.
struct PatchOutcome {
  bool in_view = false;   ///< at least one pixel inside the image
  bool tracked = false;   ///< enough usable pixels at level 0
  bool accepted = false;  ///< tracked, and consistent (chi-square gate)
  bool shrunk = false;    ///< lost pixels to occlusion
  bool extended = false;
  int usable_pixels = 0;   ///< visible, level 0
  int covered_pixels = 0;  ///< in the image, behind something that was measured before them
  int photometric_residuals = 0;
  int geometric_residuals = 0;
  double chi2_photometric = 0;  ///< sum of squared whitened residuals
  double chi2_geometric = 0;
  double robust_photometric = 0;  ///< sum of min(r^2, k |r|) of the same, with Huber's k
  double robust_geometric = 0;
  double gain = 1;             ///< brightness of the frame against the patch's reference
  double mean_error_grey = 0;  ///< mean absolute difference at level 0, brightness correction not applied
  Vector2d centre_px = Vector2d::Zero();  ///< where a square around the visible pixels has its centre
};

class PatchMeasurement final : public PoseMeasurement {
 public:
  /// All references must outlive the measurement.
  PatchMeasurement(const Config& config, const SensorRig& rig, const Workers& workers);

  /// Begins with a frame, in the memory of the one before; comes before all else. Frame and patches must stay
  /// as they are until the next one, or until nothing more is asked.
  void observe(const ObservedFrame& frame, std::span<const Patch> patches, const ResidualScale& scale);

  [[nodiscard]] int stages() const override { return config_.patches.levels; }
  [[nodiscard]] MeasurementQuadratic linearise(const PoseHypothesis& poses, int stage, bool gate) override;
  [[nodiscard]] double trial_cost(const PoseHypothesis& poses, const MeasuredVector& step,
                                  double fraction) override;
  void accept() override;

  /// One outcome a patch, from the last linearise() (which must have been of the last stage).
  [[nodiscard]] std::span<const PatchOutcome> outcomes() const { return outcomes_; }
  /// By what factors the variances of the residuals exceed their claim there (patch_scatter.hpp).
  [[nodiscard]] double photometric_variance() const { return photometric_variance_; }
  [[nodiscard]] double geometric_variance() const { return geometric_variance_; }
  /// The level-0 pixels of tracked patches there, by patch.
  [[nodiscard]] TrackedPixels tracked_pixels() const;

 private:
  /// Gain and offset of a patch's brightness, eliminated from each step (Schur complement) and carried along.
  struct Brightness {
    Vector2d value{1.0, 0.0};
    Vector2d trial{1.0, 0.0};
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Vector2d gradient = Vector2d::Zero();
    Eigen::Matrix<double, 2, 6> by_pose = Eigen::Matrix<double, 2, 6>::Zero();
  };
  /// Everything that the last linearisation fixed for one patch.
  struct PatchState {
    Brightness brightness;
    PoseQuadratic photometric;
    PoseQuadratic geometric;
    bool counts = false;  ///< has residuals, and was not rejected
  };
  /// What the last linearisation fixed for eight pixels.
  struct FixedLanes {
    PlanePairs pairs;
    Int8 photometric{};  ///< pixels with a residual
  };
  struct Level {
    LevelLanes lanes;
    std::vector<FixedLanes> fixed;
    MutualOcclusion occlusion;
  };
  /// The hypothesis for colour at all pyramid levels, and for depth.
  struct PosedLevels;

  void warp_all(const PosedLevels& posed);
  void judge_visibility(std::size_t patch, bool gate);
  void associate_planes(std::size_t patch, const PosedLevels& posed);
  void sum_photometric(std::size_t patch, const PosedLevels& posed);
  void sum_geometric(std::size_t patch, const PosedLevels& posed);
  void reduce_brightness(PatchState& state) const;
  [[nodiscard]] double measured_variance(PoseQuadratic PatchState::*kind) const;
  [[nodiscard]] double brightness_cost(const Vector2d& value) const;
  [[nodiscard]] double patch_cost(std::size_t patch, const PosedLevels& posed) const;
  [[nodiscard]] double photometric_cost(std::size_t patch, const PosedLevels& posed) const;
  [[nodiscard]] double geometric_cost(std::size_t patch, const PosedLevels& posed) const;
  [[nodiscard]] bool is_consistent(const PatchOutcome& outcome) const;
  /// Grey levels of the frame at level 0 where pixels landed; anything where they are not visible.
  [[nodiscard]] Float8 observed_at(const WarpedLanes& warped) const;
  [[nodiscard]] float photometric_share() const;
  [[nodiscard]] float geometric_share() const;

  const Config& config_;
  const SensorRig& rig_;
  const Workers& workers_;
  std::optional<ObservedFrame> frame_;
  std::span<const Patch> patches_;
  ResidualScale scale_;
  Vector3d origin_world_ = Vector3d::Zero();  ///< of the lanes' coordinates
  AssociationGates gates_;
  std::size_t finest_ = 0;  ///< level that the last linearise() began with
  std::vector<Level> levels_;
  std::vector<PatchState> states_;
  std::vector<PatchOutcome> outcomes_;
  double photometric_variance_ = 1;  ///< these two: factors on the claimed variance, by the last linearise()
  double geometric_variance_ = 1;
};

}  // namespace fusebench
