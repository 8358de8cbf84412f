#include "core/config/variants.hpp"

#include <fmt/format.h>

#include <array>
#include <sstream>
#include <string>

#include "core/base/nearest_name.hpp"
#include "core/config/config.hpp"

namespace fusebench::config {

namespace {
constexpr std::array kVariants = {
    Variant{"full", "Ours",
            "the paper's system: IMU prior, pixelwise deformation, colour and depth residuals", ""},
    Variant{"dm", "DM",
            "the direct method: the patch stays a rigid square at one depth, without visibility test; "
            "everything else "
            "as in full",
            "terms.deformation=rigid_square terms.visibility_test=false"},
    Variant{"no-imu", "without IMU", "constant velocity instead of the IMU as the prior; the same filter",
            "terms.prior=constant_velocity"},
    Variant{"dm-no-imu", "", "the direct method without IMU", "terms.prior=constant_velocity", "dm"},
    Variant{"dm-classic", "",
            "a direct method as it is without this system around it: colour alone, one pyramid level, no "
            "alignment of whole images, constant velocity",
            "terms.prior=constant_velocity terms.geometric_weight=0 patches.levels=1 "
            "alignment.coarsest_level=0",
            "dm"},
    Variant{"dm-patchwise", "",
            "each square is found by a translation of its own, as trackers of features do; poses as in dm",
            "terms.patch_motion=own_translation", "dm"},
    Variant{"planar", "", "each patch is warped by one plane, as Bloesch et al. 2017 do",
            "terms.deformation=planar"},
    Variant{"each-frame", "", "all patches are cut again in each fused frame", "patches.anchor_share=1"},
    Variant{"photometric-only", "", "no point-to-plane residuals", "terms.geometric_weight=0"},
    Variant{"geometric-only", "", "no photometric residuals", "terms.photometric_weight=0"},
    Variant{"single-iteration", "", "the plain extended Kalman filter: one iteration",
            "iekf.max_iterations=1"},
    Variant{
        "literal", "",
        "as close to the letter of the paper as runs: Eq. 22 without the prior after the first iteration, "
        "independent pixels of fixed noise, squared residuals, no brightness, drift of colour, "
        "self-calibration, "
        "motion compensation or relocalisation",
        "iekf.prior_in_every_iteration=false iekf.scatter_prior_freedom=1e9 iekf.scale_share=0 "
        "color_drift.factor=0 "
        "photometric.pixels_per_measurement=1 geometric.pixels_per_measurement=1 "
        "geometric.common_error_share=0 "
        "photometric.huber_sigmas=1e6 geometric.huber_sigmas=1e6 photometric.gain_sigma=0 "
        "photometric.offset_sigma_grey=0 patches.anchor_share=1 initialisation.imu_time_offset_sigma_s=0 "
        "self_calibration.imu_rotation_sigma_rad=0 self_calibration.gyroscope_scale_sigma=0 "
        "self_calibration.accelerometer_scale_sigma=0 "
        "terms.motion_compensation=false terms.relocalisation=false"},
    Variant{
        "literal-pixels", "",
        "literal, and Sec. 2.1.1 and Eqs. 3-4 to the letter: pixels land on whole ones, the farther of two "
        "at one place is dropped, absolute residuals",
        "photometric.sampling=whole_pixel patches.shrink_test=any_collision "
        "photometric.huber_sigmas=0.1 geometric.huber_sigmas=0.1",
        "literal"},
    Variant{
        "literal-energy", "",
        "literal-pixels, and Eq. 17 to the letter: the update sees one number, the energy of all residuals",
        "iekf.measurement=scalar_energy", "literal-pixels"},
    Variant{
        "infinitam", "InfiniTAM",
        "InfiniTAM v3 as its program runs by default, but for voxels of 1 cm: the extended tracker on depth, "
        "failures ignored",
        "system.method=infinitam depth.min_m=0.2 depth.max_m=3 depth.noise_floor_m=1e-5 "
        "depth.noise_quadratic_per_m=0 tsdf.truncation_m=0.05 tsdf.truncation_sigmas=0 tsdf.max_weight=100"},
    Variant{"infinitam-color", "",
            "infinitam with its tracker of depth and intensities, by the program's own settings for it",
            "infinitam.use_color=true infinitam.rotation_levels=0 infinitam.full_levels=3", "infinitam"},
    Variant{"infinitam-icp", "", "infinitam with the plain ICP tracker of KinectFusion",
            "infinitam.tracker=icp infinitam.rotation_levels=3 infinitam.iterations_coarse=10 "
            "infinitam.iterations_fine=2 infinitam.gate_coarse=0.01 infinitam.gate_fine=0.002 "
            "infinitam.min_step=1e-3",
            "infinitam"},
    Variant{"opencv-rgbd", "", "OpenCV's RgbdOdometry from frame to frame (Steinbruecker et al. 2011)",
            "system.method=opencv_odometry opencv_odometry.method=rgbd"},
    Variant{"opencv-icp", "", "OpenCV's ICPOdometry from frame to frame",
            "system.method=opencv_odometry opencv_odometry.method=icp"},
    Variant{"opencv-rgbdicp", "", "OpenCV's RgbdICPOdometry from frame to frame: colour and depth",
            "system.method=opencv_odometry opencv_odometry.method=rgbd_icp"},
    Variant{
        "bundlefusion", "BundleFusion",
        "BundleFusion's method with one setting for all recordings: SIFT and depth in chunks of ten frames, "
        "every chunk matched with all others; the model is fused once, at the final poses",
        "system.method=bundlefusion depth.min_m=0.1 depth.max_m=3 depth.noise_floor_m=1e-5 "
        "depth.noise_quadratic_per_m=0 tsdf.voxel_m=0.01 tsdf.truncation_m=0.08 tsdf.truncation_sigmas=0 "
        "tsdf.max_weight=2048"},
    Variant{"elasticfusion", "ElasticFusion",
            "ElasticFusion's method: surfels, tracked by colour and depth together, with local and global "
            "loops that deform them",
            "system.method=elasticfusion depth.min_m=0.3 depth.max_m=3"},
    Variant{"elasticfusion-open", "",
            "elasticfusion without loops; surfels stay active for ever, as with the program's flag for it",
            "elasticfusion.loops=none elasticfusion.time_window=1000000", "elasticfusion"},
    Variant{"elasticfusion-imu", "", "elasticfusion with the inertial term of Laidlow et al. 2017",
            "elasticfusion.use_imu=true", "elasticfusion"},
};
}  // namespace

std::span<const Variant> all_variants() { return kVariants; }

Result<Variant> find_variant(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Variant& variant : kVariants) {
    if (variant.name == name) return variant;
    names.push_back(variant.name);
  }
  return fail(ErrorCode::usage, fmt::format("unknown variant '{}'{}", name, nearest_hint(name, names)),
              fmt::format("variants are {}", fmt::join(names, ", ")));
}

EffectiveConfig variant_config(const Variant& variant) {
  EffectiveConfig config;
  if (!variant.base.empty()) {
    const Result<Variant> base = find_variant(variant.base);
    check(base.has_value(), "the table of variants is based on rows of itself");
    config = variant_config(*base);
  }
  std::istringstream edits{std::string(variant.edits)};
  for (std::string edit; edits >> edit;) {
    const auto equals = edit.find('=');
    const auto set = config.set(edit.substr(0, equals), parse_option_value(edit.substr(equals + 1)),
                                fmt::format("variant {}", variant.name));
    check(set.has_value(), "the table of variants edits existing options");
  }
  return config;
}

bool needs_imu(const Config& config) {
  return (config.system.method == SystemMethod::filter && config.terms.prior == Prior::imu) ||
         (config.system.method == SystemMethod::elasticfusion && config.elasticfusion.use_imu);
}

}  // namespace fusebench::config
