#include "tests/bench/peers/open3d_fusions.hpp"

#include <fmt/format.h>
#include <open3d/Open3DConfig.h>
#include <open3d/camera/PinholeCameraIntrinsic.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/RGBDImage.h>
#include <open3d/pipelines/integration/ScalableTSDFVolume.h>
#include <open3d/t/geometry/Image.h>
#include <open3d/t/geometry/PointCloud.h>
#include <open3d/t/geometry/VoxelBlockGrid.h>
#include <open3d/utility/Logging.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace fusebench::peers {

namespace {

namespace o3 = open3d;

Eigen::Matrix4d T_camera_world(const SE3& T_world_camera) {
  const SE3 inverse = T_world_camera.inverse();
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = inverse.rotation_matrix();
  matrix.topRightCorner<3, 1>() = inverse.translation;
  return matrix;
}

/// The volume of the first generation, with its default blocks of 16^3 voxels.
class ScalableVolume final : public Contestant {
 public:
  ScalableVolume(const PinholeCamera& camera, const FieldSettings& field)
      : intrinsic_(camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px),
        volume_(field.voxel_m, field.truncation_m, o3::pipelines::integration::TSDFVolumeColorType::RGB8) {}

  void receive(const ContestFrame& frame) override {
    const DepthImage& depth_m = frame.fusible.depth_m;
    image_.depth_.Prepare(depth_m.width, depth_m.height, 1, sizeof(float));
    std::memcpy(image_.depth_.data_.data(), depth_m.data.data(), image_.depth_.data_.size());
    const ColorImage& color = frame.fusible.color;
    image_.color_.Prepare(color.width, color.height, 3, 1);
    std::memcpy(image_.color_.data_.data(), color.data.data(), image_.color_.data_.size());
    T_camera_world_ = T_camera_world(frame.T_world_camera);
  }

  void work() override { volume_.Integrate(image_, intrinsic_, T_camera_world_); }

  [[nodiscard]] FusedSurface surface() override {
    return {volume_.volume_units_.size(), volume_.volume_unit_resolution_,
            volume_.ExtractPointCloud()->points_};
  }

 private:
  o3::camera::PinholeCameraIntrinsic intrinsic_;
  o3::pipelines::integration::ScalableTSDFVolume volume_;
  o3::geometry::RGBDImage image_;
  Eigen::Matrix4d T_camera_world_ = Eigen::Matrix4d::Identity();
};

/// The volume of the second generation, in the types that its documentation calls efficient: 16-bit weights
/// and colours, depth and colour as raw integers.
class BlockGrid final : public Contestant {
 public:
  BlockGrid(const PinholeCamera& camera, const FieldSettings& field, int block_side_voxels)
      : field_(field),
        block_side_voxels_(block_side_voxels),
        intrinsic_(std::vector<double>{camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1},
                   {3, 3}, o3::core::Float64),
        // Room for more than a hand-held recording of a room fills, so that growing costs no frame.
        grid_({"tsdf", "weight", "color"}, {o3::core::Float32, o3::core::UInt16, o3::core::UInt16},
              {{1}, {1}, {3}}, static_cast<float>(field.voxel_m), block_side_voxels,
              block_side_voxels == 8 ? 40000 : 10000) {}

  void receive(const ContestFrame& frame) override {
    const DepthImage& depth_m = frame.fusible.depth_m;
    std::vector<std::uint16_t> raw(depth_m.data.size());
    for (std::size_t i = 0; i < raw.size(); ++i)
      raw[i] = static_cast<std::uint16_t>(std::lround(kUnitsPerMetre * depth_m.data[i]));
    depth_ = o3::core::Tensor(raw, {depth_m.height, depth_m.width, 1}, o3::core::UInt16);
    const ColorImage& color = frame.fusible.color;
    color_ = o3::core::Tensor(reinterpret_cast<const std::uint8_t*>(color.data.data()),
                              {color.height, color.width, 3}, o3::core::UInt8);
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> pose = T_camera_world(frame.T_world_camera);
    T_camera_world_ = o3::core::Tensor(pose.data(), {4, 4}, o3::core::Float64);
  }

  void work() override {
    const auto max_depth_m = static_cast<float>(field_.max_depth_m);
    const auto truncation_voxels = static_cast<float>(field_.truncation_m / field_.voxel_m);
    const o3::core::Tensor blocks = grid_.GetUniqueBlockCoordinates(
        depth_, intrinsic_, T_camera_world_, kUnitsPerMetre, max_depth_m, truncation_voxels);
    grid_.Integrate(blocks, depth_, color_, intrinsic_, T_camera_world_, kUnitsPerMetre, max_depth_m,
                    truncation_voxels);
  }

  [[nodiscard]] FusedSurface surface() override {
    constexpr float kLeastWeight = 1;
    FusedSurface surface;
    surface.blocks = static_cast<std::size_t>(grid_.GetHashMap().Size());
    surface.block_side_voxels = block_side_voxels_;
    const auto coordinates_m =
        grid_.ExtractPointCloud(kLeastWeight).GetPointPositions().ToFlatVector<float>();
    for (std::size_t i = 0; i + 2 < coordinates_m.size(); i += 3)
      surface.points_world.emplace_back(coordinates_m[i], coordinates_m[i + 1], coordinates_m[i + 2]);
    return surface;
  }

 private:
  static constexpr float kUnitsPerMetre = 5000;  // TUM's: 13 m in 16 bits

  FieldSettings field_;
  int block_side_voxels_;
  o3::core::Tensor intrinsic_;
  o3::t::geometry::VoxelBlockGrid grid_;
  o3::t::geometry::Image depth_;
  o3::t::geometry::Image color_;
  o3::core::Tensor T_camera_world_;
};

template <class Volume, class... Options>
Peer peer(const char* name, const char* settings, Options... options) {
  return {.name = fmt::format("Open3D {} {}", OPEN3D_VERSION, name),
          .settings = settings,
          .package = "libopen3d-dev",
          .task = Task::fusion,
          .make = [options...](const PinholeCamera& camera,
                               const FieldSettings& field) -> std::unique_ptr<Contestant> {
            o3::utility::SetVerbosityLevel(o3::utility::VerbosityLevel::Error);
            return std::make_unique<Volume>(camera, field, options...);
          }};
}

}  // namespace

std::vector<Peer> open3d_fusions() {
  return {peer<ScalableVolume>("ScalableTSDFVolume", "with colour"),
          peer<BlockGrid>("VoxelBlockGrid", "with colour, blocks of 16^3", 16),
          peer<BlockGrid>("VoxelBlockGrid", "with colour, blocks of 8^3", 8)};
}

}  // namespace fusebench::peers
