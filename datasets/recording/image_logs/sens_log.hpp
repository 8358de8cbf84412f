// .sens files, version 4, of BundleFusion and ScanNet (Dai et al., TOG 2017; CVPR 2017). Little-endian:
//
//     uint32 4; uint64 n, n bytes: the sensor's name
//     float32[16] x 4      4x4 row-major: K of colour, pose of colour, K of depth, pose of depth (in the rig)
//     int32 colour codec   0 plain RGB, 1 PNG, 2 JPEG
//     int32 depth codec    0 plain, 1 zlib stream, 2 occipital
//     uint32 x 4           width and height of colour, of depth
//     float32              value of one metre in depth; uint64 frames
//     of each frame        float32[16] camera to world, row-major, all -inf: none; uint64 x 2 stamps of
//     colour
//                          and depth; uint64 x 2 bytes of colour and depth; colour; depth
//     uint64 IMU frames    of 15 float64 and an uint64 stamp each: rate of rotation, acceleration, magnetic
//                          field, attitude, gravity (x, y, z each)
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/image_logs/little_endian.hpp"

namespace fusebench::image_logs {

enum class SensColorCodec : std::int32_t { plain = 0, png = 1, jpeg = 2 };
enum class SensDepthCodec : std::int32_t { plain = 0, zlib = 1, occipital = 2 };

struct SensHeader {
  std::string sensor_name;
  PinholeCamera color;
  PinholeCamera depth;
  std::optional<SE3> T_rig_color = SE3{};  ///< nothing: what the file has is no rigid transform
  std::optional<SE3> T_rig_depth = SE3{};
  SensColorCodec color_codec = SensColorCodec::jpeg;
  SensDepthCodec depth_codec = SensDepthCodec::zlib;
  float depth_units_per_metre = 1000;
  std::uint64_t frames = 0;
};

struct SensFrame {
  std::optional<SE3> T_world_camera;     ///< what the program that wrote the file estimated
  std::uint64_t color_timestamp_us = 0;  ///< the format does not say the unit; ours are microseconds
  std::uint64_t depth_timestamp_us = 0;
  std::string color;           ///< as it is stored: see SensHeader::color_codec
  Image<std::uint16_t> depth;  ///< in units of the format, 0 = no measurement
};

/// Where the images of a frame are stored.
struct SensFrameParts {
  std::optional<SE3> T_world_camera;
  std::uint64_t color_timestamp = 0;  ///< in the unit of who wrote the file
  std::uint64_t depth_timestamp = 0;
  std::uint64_t color_position = 0;  ///< in the file
  std::uint64_t color_bytes = 0;
  std::uint64_t depth_position = 0;
  std::uint64_t depth_bytes = 0;
};

/// As the program of an iOS device wrote it.
struct SensImuFrame {
  Vector3d rotation_rate = Vector3d::Zero();
  Vector3d acceleration = Vector3d::Zero();
  Vector3d gravity = Vector3d::Zero();
  std::uint64_t timestamp = 0;
};

/// The depth image of stored bytes; nothing if they are damaged, of another number of pixels or in the
/// occipital codec.
[[nodiscard]] std::optional<Image<std::uint16_t>> sens_depth(const SensHeader& header,
                                                             std::string_view bytes);

/// The bytes of a header and of a frame with depth as a zlib stream.
[[nodiscard]] std::string sens_bytes(const SensHeader& header);
[[nodiscard]] std::string sens_bytes(const SensFrame& frame);

/// Reads a file frame by frame.
class SensReader {
 public:
  /// Errors: data_missing; data_corrupt (another version, a size, codec or camera that cannot be).
  [[nodiscard]] static Result<SensReader> open(const std::filesystem::path& file);

  [[nodiscard]] const SensHeader& header() const { return header_; }
  /// Nothing after the last one. Errors: data_corrupt (the file ends early, depth that is damaged, of another
  /// size or in the occipital codec; a pose that is no rigid transform).
  [[nodiscard]] Result<std::optional<SensFrame>> next();
  /// The same with the places of the images in place of the images.
  [[nodiscard]] Result<std::optional<SensFrameParts>> next_parts();
  /// The inertial frames, when all others have been read (checked). A file may end without them. Errors:
  /// data_corrupt (more frames than there are bytes, a number that is not finite).
  [[nodiscard]] Result<std::vector<SensImuFrame>> imu_frames();

 private:
  struct FrameHead {
    SensFrame frame;
    std::uint64_t color_bytes = 0;
    std::uint64_t depth_bytes = 0;
  };
  SensReader(LittleEndianReader reader, SensHeader header);
  [[nodiscard]] FrameHead take_head();

  LittleEndianReader reader_;
  SensHeader header_;
  std::uint64_t read_ = 0;
};

/// The poses of all frames that have one, T_world_camera by the stamps of colour (microseconds): what
/// BundleFusion made of a recording. Errors: those of SensReader; data_corrupt (stamps that do not rise, no
/// pose at all).
[[nodiscard]] Result<Trajectory> read_sens_trajectory(const std::filesystem::path& file);

}  // namespace fusebench::image_logs
