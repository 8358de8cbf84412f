#include "core/all_systems.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/baselines/bundlefusion/bundlefusion_system.hpp"
#include "core/baselines/elasticfusion/elasticfusion_system.hpp"
#include "core/baselines/infinitam/infinitam_system.hpp"
#include "core/baselines/opencv_odometry/opencv_odometry_system.hpp"
#include "core/config/config.hpp"
#include "core/paper_system.hpp"

namespace fusebench::core {

namespace {

using MadeSystem = std::unique_ptr<system::System>;

MadeSystem make_filter(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                       const Workers& workers, Replay replay) {
  return std::make_unique<PaperSystem>(config, rig, imu, workers, std::move(replay));
}

MadeSystem make_infinitam(const config::Config& config, const SensorRig& rig,
                          std::span<const ImuSample> /*imu*/, const Workers& workers, Replay /*replay*/) {
  return std::make_unique<baselines::infinitam::InfinitamSystem>(config.infinitam, config.depth, config.tsdf,
                                                                 rig, workers);
}

MadeSystem make_opencv_odometry(const config::Config& config, const SensorRig& rig,
                                std::span<const ImuSample> /*imu*/, const Workers& workers,
                                Replay /*replay*/) {
  return std::make_unique<baselines::opencv_odometry::OpencvOdometrySystem>(
      config.opencv_odometry.method, config.depth, config.tsdf, rig, workers);
}

MadeSystem make_bundlefusion(const config::Config& config, const SensorRig& rig,
                             std::span<const ImuSample> /*imu*/, const Workers& workers, Replay replay) {
  return std::make_unique<baselines::bundlefusion::BundlefusionSystem>(
      config.bundlefusion, config.depth, config.tsdf, rig, workers, std::move(replay));
}

MadeSystem make_elasticfusion(const config::Config& config, const SensorRig& rig,
                              std::span<const ImuSample> imu, const Workers& workers, Replay /*replay*/) {
  return std::make_unique<baselines::elasticfusion::ElasticfusionSystem>(config, rig, imu, workers);
}

constexpr std::string_view kAnyThreads = "any number, with the same results";

constexpr std::array kSystems = {
    SystemRow{config::SystemMethod::filter, "filter",
              "the paper's iterated filter over colour, depth and IMU (Zhu & Xu 2019), and its ablations",
              "all but those named after a system", kAnyThreads, &make_filter},
    SystemRow{config::SystemMethod::infinitam, "infinitam",
              "InfiniTAM's trackers and relocaliser (Kaehler et al. 2015, Glocker et al. 2015) on this "
              "program's TSDF and ray casting",
              "infinitam depth tsdf", kAnyThreads, &make_infinitam},
    SystemRow{config::SystemMethod::opencv_odometry, "opencv_odometry",
              "OpenCV's odometries (module rgbd) from frame to frame, fused by this program's TSDF",
              "opencv_odometry depth tsdf", kAnyThreads, &make_opencv_odometry},
    SystemRow{
        config::SystemMethod::bundlefusion, "bundlefusion",
        "BundleFusion's chunks of matched keypoints and depth, adjusted all together (Dai et al. 2017), "
        "fused at the end by this program's TSDF",
        "bundlefusion depth tsdf", kAnyThreads, &make_bundlefusion},
    SystemRow{config::SystemMethod::elasticfusion, "elasticfusion",
              "ElasticFusion's surfels (Whelan et al. 2015), tracked by colour and depth together and bent "
              "where places are seen again",
              "elasticfusion depth", kAnyThreads, &make_elasticfusion},
};

}  // namespace

std::span<const SystemRow> all_systems() { return kSystems; }

MadeSystem make_system(const config::Config& config, const SensorRig& rig, std::span<const ImuSample> imu,
                       const Workers& workers, Replay replay) {
  const auto row = std::ranges::find(kSystems, config.system.method, &SystemRow::method);
  check(row != kSystems.end(), "the table of systems has a row for each system.method");
  return row->make(config, rig, imu, workers, std::move(replay));
}

}  // namespace fusebench::core
