#include "datasets/recording/image_logs/sens_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/image_logs/zlib_bytes.hpp"

namespace fusebench::image_logs {

namespace {

constexpr std::uint32_t kVersion = 4;
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
constexpr std::uint32_t kMostPixelsASide = 16384;
constexpr std::size_t kMatrixSize = 16;
constexpr std::uint64_t kImuFrameBytes = 16 * 8;
using Floats16 = std::array<float, kMatrixSize>;

constexpr Floats16 kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

void append_matrix(std::string& bytes, const Floats16& rows) {
  for (const float value : rows) append_number(bytes, value);
}

Floats16 intrinsic_rows(const PinholeCamera& camera) {
  Floats16 rows = kIdentity;
  rows[0] = static_cast<float>(camera.fx_px);
  rows[2] = static_cast<float>(camera.cx_px);
  rows[5] = static_cast<float>(camera.fy_px);
  rows[6] = static_cast<float>(camera.cy_px);
  return rows;
}

Floats16 pose_rows(const std::optional<SE3>& T_world_camera) {
  Floats16 rows{};
  if (!T_world_camera) {
    rows.fill(-std::numeric_limits<float>::infinity());
    return rows;
  }
  const Matrix3d R = T_world_camera->rotation_matrix();
  for (int row = 0; row < 3; ++row) {
    float* const begin = &rows[static_cast<std::size_t>(4 * row)];
    for (int column = 0; column < 3; ++column) begin[column] = static_cast<float>(R(row, column));
    begin[3] = static_cast<float>(T_world_camera->translation[row]);
  }
  rows[kMatrixSize - 1] = 1;
  return rows;
}

Floats16 take_matrix(LittleEndianReader& reader, std::string_view what) {
  Floats16 rows{};
  for (float& value : rows) value = reader.number<float>(what);
  return rows;
}

PinholeCamera take_intrinsics(LittleEndianReader& reader, std::string_view what) {
  const Floats16 rows = take_matrix(reader, what);
  return {0, 0, rows[0], rows[5], rows[2], rows[6]};
}

void take_size(LittleEndianReader& reader, std::string_view what, PinholeCamera& camera) {
  const auto width = reader.number<std::uint32_t>(what);
  const auto height = reader.number<std::uint32_t>(what);
  if (width < 1 || height < 1 || width > kMostPixelsASide || height > kMostPixelsASide)
    reader.complain(fmt::format("{} = {}x{} pixels (allowed 1x1 .. {}x{})", what, width, height,
                                kMostPixelsASide, kMostPixelsASide));
  camera.width_px = static_cast<int>(width);
  camera.height_px = static_cast<int>(height);
}

template <class Codec>
Codec take_codec(LittleEndianReader& reader, std::string_view what) {
  const auto value = reader.number<std::int32_t>(what);
  if (value < 0 || value > 2) reader.complain(fmt::format("{} = {} (allowed 0 .. 2)", what, value));
  return static_cast<Codec>(value);
}

/// Of a camera in the rig; the identity where the matrix is left empty.
std::optional<SE3> take_rig_pose(LittleEndianReader& reader, std::string_view what) {
  const Floats16 rows = take_matrix(reader, what);
  if (std::ranges::all_of(rows, [](float value) { return value == 0; })) return SE3{};
  if (!std::ranges::all_of(rows, [](float value) { return std::isfinite(value); })) return std::nullopt;
  std::array<double, 12> upper{};
  std::copy_n(rows.begin(), upper.size(), upper.begin());
  return calibration::rigid_transform(upper);
}

Vector3d take_vector(LittleEndianReader& reader) {
  const double x = reader.number<double>("an inertial frame");
  const double y = reader.number<double>("an inertial frame");
  const double z = reader.number<double>("an inertial frame");
  return {x, y, z};
}

/// Nothing for a frame without a pose.
std::optional<SE3> take_pose(LittleEndianReader& reader) {
  const Floats16 rows = take_matrix(reader, "the pose");
  if (!std::ranges::all_of(rows, [](float value) { return std::isfinite(value); })) return std::nullopt;
  std::array<double, 12> upper{};
  std::copy_n(rows.begin(), upper.size(), upper.begin());
  const auto pose = calibration::rigid_transform(upper);
  if (!pose)
    reader.complain(fmt::format("the pose is no rigid transform ({})", calibration::kRigidTransformRule));
  return pose;
}

}  // namespace

std::optional<Image<std::uint16_t>> sens_depth(const SensHeader& header, std::string_view bytes) {
  if (header.depth_codec == SensDepthCodec::occipital) return std::nullopt;
  const auto unpack = header.depth_codec == SensDepthCodec::plain ? plain_depth : unpacked_depth;
  return unpack(bytes, header.depth.width_px, header.depth.height_px);
}

std::string sens_bytes(const SensHeader& header) {
  std::string bytes;
  append_number(bytes, kVersion);
  append_number<std::uint64_t>(bytes, header.sensor_name.size());
  bytes += header.sensor_name;
  append_matrix(bytes, intrinsic_rows(header.color));
  append_matrix(bytes, pose_rows(header.T_rig_color.value_or(SE3{})));
  append_matrix(bytes, intrinsic_rows(header.depth));
  append_matrix(bytes, pose_rows(header.T_rig_depth.value_or(SE3{})));
  append_number(bytes, static_cast<std::int32_t>(header.color_codec));
  append_number(bytes, static_cast<std::int32_t>(header.depth_codec));
  for (const PinholeCamera* camera : {&header.color, &header.depth}) {
    append_number(bytes, static_cast<std::uint32_t>(camera->width_px));
    append_number(bytes, static_cast<std::uint32_t>(camera->height_px));
  }
  append_number(bytes, header.depth_units_per_metre);
  append_number(bytes, header.frames);
  return bytes;
}

std::string sens_bytes(const SensFrame& frame) {
  const std::string depth = packed_depth(frame.depth);
  std::string bytes;
  append_matrix(bytes, pose_rows(frame.T_world_camera));
  append_number(bytes, frame.color_timestamp_us);
  append_number(bytes, frame.depth_timestamp_us);
  append_number<std::uint64_t>(bytes, frame.color.size());
  append_number<std::uint64_t>(bytes, depth.size());
  return bytes + frame.color + depth;
}

SensReader::SensReader(LittleEndianReader reader, SensHeader header)
    : reader_(std::move(reader)), header_(std::move(header)) {}

Result<SensReader> SensReader::open(const std::filesystem::path& file) {
  auto opened = LittleEndianReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  LittleEndianReader& reader = *opened;
  const auto version = reader.number<std::uint32_t>("the version");
  if (version != kVersion) reader.complain(fmt::format("version {} (only {} is read)", version, kVersion));
  SensHeader header;
  header.sensor_name = reader.bytes(reader.number<std::uint64_t>("the name's length"), "the sensor's name");
  header.color = take_intrinsics(reader, "K of colour");
  header.T_rig_color = take_rig_pose(reader, "pose of colour");
  header.depth = take_intrinsics(reader, "K of depth");
  header.T_rig_depth = take_rig_pose(reader, "pose of depth");
  header.color_codec = take_codec<SensColorCodec>(reader, "codec of colour");
  header.depth_codec = take_codec<SensDepthCodec>(reader, "codec of depth");
  take_size(reader, "size of colour", header.color);
  take_size(reader, "size of depth", header.depth);
  header.depth_units_per_metre = reader.number<float>("value of one metre");
  if (!(header.depth_units_per_metre > 0))
    reader.complain(fmt::format("value of one metre = {} (allowed: above 0)", header.depth_units_per_metre));
  header.frames = reader.number<std::uint64_t>("the number of frames");
  if (reader.error()) return tl::unexpected(*reader.error());
  return SensReader(std::move(reader), std::move(header));
}

SensReader::FrameHead SensReader::take_head() {
  FrameHead head;
  head.frame.T_world_camera = take_pose(reader_);
  head.frame.color_timestamp_us = reader_.number<std::uint64_t>("stamp of colour");
  head.frame.depth_timestamp_us = reader_.number<std::uint64_t>("stamp of depth");
  head.color_bytes = reader_.number<std::uint64_t>("bytes of colour");
  head.depth_bytes = reader_.number<std::uint64_t>("bytes of depth");
  return head;
}

Result<std::optional<SensFrame>> SensReader::next() {
  if (read_ >= header_.frames) return std::nullopt;
  FrameHead head = take_head();
  head.frame.color = reader_.bytes(head.color_bytes, "colour");
  const std::string depth = reader_.bytes(head.depth_bytes, "depth");
  if (reader_.error()) return tl::unexpected(*reader_.error());
  if (header_.depth_codec == SensDepthCodec::occipital)
    reader_.complain("depth is in the occipital codec, which is not read");
  auto values = sens_depth(header_, depth);
  if (!values)
    reader_.complain(fmt::format("frame {}: depth is damaged, or not of {}x{} pixels", read_,
                                 header_.depth.width_px, header_.depth.height_px));
  if (reader_.error()) return tl::unexpected(*reader_.error());
  head.frame.depth = std::move(*values);
  ++read_;
  return std::move(head.frame);
}

Result<std::optional<SensFrameParts>> SensReader::next_parts() {
  if (read_ >= header_.frames) return std::nullopt;
  const FrameHead head = take_head();
  SensFrameParts parts{head.frame.T_world_camera, head.frame.color_timestamp_us,
                       head.frame.depth_timestamp_us};
  parts.color_position = reader_.position();
  parts.color_bytes = head.color_bytes;
  reader_.skip(head.color_bytes, "colour");
  parts.depth_position = reader_.position();
  parts.depth_bytes = head.depth_bytes;
  reader_.skip(head.depth_bytes, "depth");
  if (reader_.error()) return tl::unexpected(*reader_.error());
  ++read_;
  return parts;
}

Result<std::vector<SensImuFrame>> SensReader::imu_frames() {
  check(read_ == header_.frames, "all frames were read");
  if (reader_.left() == 0) return std::vector<SensImuFrame>();
  const auto count = reader_.number<std::uint64_t>("the number of inertial frames");
  if (count > reader_.left() / kImuFrameBytes)
    reader_.complain(fmt::format("{} inertial frames in {} bytes", count, reader_.left()));
  if (reader_.error()) return tl::unexpected(*reader_.error());
  std::vector<SensImuFrame> frames;
  frames.reserve(count);
  for (std::uint64_t k = 0; k < count; ++k) {
    SensImuFrame frame;
    frame.rotation_rate = take_vector(reader_);
    frame.acceleration = take_vector(reader_);
    static_cast<void>(take_vector(reader_));  // magnetic field
    static_cast<void>(take_vector(reader_));  // attitude
    frame.gravity = take_vector(reader_);
    frame.timestamp = reader_.number<std::uint64_t>("an inertial frame");
    if (!(frame.rotation_rate.allFinite() && frame.acceleration.allFinite() && frame.gravity.allFinite()))
      reader_.complain(fmt::format("inertial frame {} has a number that is not finite", k));
    if (reader_.error()) return tl::unexpected(*reader_.error());
    frames.push_back(frame);
  }
  return frames;
}

Result<Trajectory> read_sens_trajectory(const std::filesystem::path& file) {
  constexpr std::uint64_t kMost_us =
      std::numeric_limits<std::int64_t>::max() / 2 / kNanosecondsPerMicrosecond;
  auto reader = SensReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  Trajectory trajectory;
  while (true) {
    const auto frame = reader->next_parts();
    if (!frame) return tl::unexpected(frame.error());
    if (!*frame) break;
    if (!(*frame)->T_world_camera) continue;
    const std::uint64_t stamp_us = (*frame)->color_timestamp;
    const auto stamp_ns =
        static_cast<std::int64_t>(std::min(stamp_us, kMost_us)) * kNanosecondsPerMicrosecond;
    if (stamp_us > kMost_us || (!trajectory.empty() && stamp_ns <= trajectory.back().timestamp_ns))
      return fail(
          ErrorCode::data_corrupt,
          fmt::format("{}: colour's stamp {} us does not rise, or is too large", file.string(), stamp_us));
    trajectory.push_back({stamp_ns, *(*frame)->T_world_camera});
  }
  if (trajectory.empty())
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: none of its {} frames has a pose", file.string(), reader->header().frames));
  return trajectory;
}

}  // namespace fusebench::image_logs
