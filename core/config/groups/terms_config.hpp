// Options: the terms of the estimator that an ablation switches.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// The prediction of the state between frames.
enum class Prior { imu, constant_velocity };
constexpr auto option_choices(Prior) {
  return choices<Prior>({{"imu", Prior::imu}, {"constant_velocity", Prior::constant_velocity}});
}

/// The deformation model of a patch between frames.
enum class Deformation { pixelwise, planar, rigid_square };
constexpr auto option_choices(Deformation) {
  return choices<Deformation>({{"pixelwise", Deformation::pixelwise},
                               {"planar", Deformation::planar},
                               {"rigid_square", Deformation::rigid_square}});
}

/// The tracking of a patch in the current frame.
enum class PatchMotion { by_pose, own_translation };
constexpr auto option_choices(PatchMotion) {
  return choices<PatchMotion>(
      {{"by_pose", PatchMotion::by_pose}, {"own_translation", PatchMotion::own_translation}});
}

/// The terms of the estimator that an ablation switches.
struct TermsConfig {
  Prior prior = Prior::imu;
  Deformation deformation = Deformation::pixelwise;
  PatchMotion patch_motion = PatchMotion::by_pose;
  bool visibility_test = true;
  bool motion_compensation = true;
  bool relocalisation = true;
  double photometric_weight = 1.0;
  double geometric_weight = 1.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice("prior", self.prior, "prediction of the state: by the IMU (Eqs. 11-14) or constant velocity");
    v.choice(
        "deformation", self.deformation,
        "shape change of patches: each pixel by its own depth (Eqs. 1-2), one plane a patch (Bloesch et al. "
        "2017), or a rigid square at one depth (the direct method)");
    v.choice("patch_motion", self.patch_motion,
             "patches are tracked by one pose for all (Eq. 5), or each by its own translation in the image, "
             "starting at its predicted position (Lucas & Kanade 1981); both give the same pose");
    v.flag("visibility_test", self.visibility_test,
           "drop pixels that are occluded in the current frame (the shrink effect, Sec. 2.1.1)");
    v.flag("motion_compensation", self.motion_compensation,
           "compensates rolling shutter and depth delay: all rows of colour and depth are moved to one time "
           "by the estimated velocity (not in the paper)");
    v.flag("relocalisation", self.relocalisation,
           "a lost frame is relocalised against stored keyframes (ORB features and their 3D points; "
           "Mur-Artal & Tardos 2017; not in the paper)");
    v.number("photometric_weight", self.photometric_weight, 0.0, 1e3,
             "factor on the information of the photometric residuals (Eq. 3); 0 switches the term off");
    v.number("geometric_weight", self.geometric_weight, 0.0, 1e3,
             "factor on the information of the point-to-plane residuals (Eq. 4); 0 switches the term off");
  }
};

}  // namespace fusebench::config
