#include "datasets/recording/formats/rosbag/ros_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "datasets/calibration/distortion_model.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::formats::rosbag {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr double kMostParameter = 1e6;

/// Takes values from the front of a message; after one that is not there, all are zero or empty.
class Values {
 public:
  explicit Values(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool failed() const { return failed_; }

  std::string_view take(std::size_t count) {
    if (failed_ || count > bytes_.size()) {
      failed_ = true;
      return {};
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  template <class Number>
  Number number() {
    const std::string_view taken = take(sizeof(Number));
    if (failed_) return Number{};
    std::array<char, sizeof(Number)> raw{};
    std::ranges::copy(taken, raw.begin());
    return std::bit_cast<Number>(raw);
  }
  std::string_view bytes() { return take(number<std::uint32_t>()); }
  Vector3d vector() {
    const auto x = number<double>();
    const auto y = number<double>();
    const auto z = number<double>();
    return {x, y, z};
  }
  Header header() {
    take(4);  // a number of the sequence
    const auto seconds = static_cast<std::int64_t>(number<std::uint32_t>());
    const auto nanoseconds = static_cast<std::int64_t>(number<std::uint32_t>());
    return {seconds * kNanosecondsPerSecond + nanoseconds, std::string(bytes())};
  }

 private:
  std::string_view bytes_;
  bool failed_ = false;
};

bool is_compressed_color(std::string_view encoding) {
  return encoding.find("jpeg") != std::string_view::npos || encoding.find("jpg") != std::string_view::npos ||
         encoding.find("png") != std::string_view::npos;
}

}  // namespace

bool is_grey_encoding(std::string_view encoding) { return encoding == "mono8"; }

bool is_color_encoding(std::string_view encoding) {
  return encoding == "rgb8" || encoding == "bgr8" || encoding == "rgba8" || encoding == "bgra8" ||
         is_grey_encoding(encoding);
}

bool is_depth_encoding(std::string_view encoding) {
  return encoding == "16UC1" || encoding == "mono16" || encoding == "32FC1";
}

bool is_compressed_depth(std::string_view encoding) {
  return encoding.find("compressedDepth") != std::string_view::npos;
}

std::optional<ImageMessage> image_message(std::string_view data) {
  Values values(data);
  ImageMessage image;
  image.header = values.header();
  image.height_px = values.number<std::uint32_t>();
  image.width_px = values.number<std::uint32_t>();
  image.encoding = values.bytes();
  image.is_big_endian = values.number<std::uint8_t>() != 0;
  image.step_bytes = values.number<std::uint32_t>();
  image.data = values.bytes();
  return values.failed() ? std::nullopt : std::optional(std::move(image));
}

std::optional<ImageMessage> compressed_image_message(std::string_view data) {
  Values values(data);
  ImageMessage image;
  image.header = values.header();
  image.encoding = values.bytes();
  image.data = values.bytes();
  return values.failed() ? std::nullopt : std::optional(std::move(image));
}

std::optional<ImuMessage> imu_message(std::string_view data) {
  constexpr std::size_t kOrientation = (4 + 9) * 8;
  constexpr std::size_t kCovariance = 9 * 8;
  Values values(data);
  ImuMessage imu;
  imu.header = values.header();
  values.take(kOrientation);
  imu.angular_velocity_radps = values.vector();
  values.take(kCovariance);
  imu.specific_force_mps2 = values.vector();
  values.take(kCovariance);
  if (values.failed() || !imu.angular_velocity_radps.allFinite() || !imu.specific_force_mps2.allFinite())
    return std::nullopt;
  return imu;
}

std::optional<Result<calibration::CalibratedCamera>> camera_info_message(std::string_view data) {
  constexpr std::uint32_t kMostCoefficients = 64;
  Values values(data);
  static_cast<void>(values.header());
  const auto height = values.number<std::uint32_t>();
  const auto width = values.number<std::uint32_t>();
  const std::string model(values.bytes());
  const auto count = values.number<std::uint32_t>();
  if (count > kMostCoefficients) return std::nullopt;
  std::vector<double> d(count);
  for (double& value : d) value = values.number<double>();
  std::array<double, 9> K{};
  for (double& value : K) value = values.number<double>();
  const auto possible = [](double value) { return std::abs(value) <= kMostParameter; };
  if (values.failed() || !(K[0] > 0 && K[4] > 0) || !std::ranges::all_of(K, possible) ||
      !std::ranges::all_of(d, possible) || width < 1 || height < 1 || width > kMostPixelsASide ||
      height > kMostPixelsASide)
    return std::nullopt;
  const auto distortion = calibration::distortion_of_model(model, d);
  if (!distortion) return Result<calibration::CalibratedCamera>(tl::unexpected(distortion.error()));
  calibration::CalibratedCamera camera;
  camera.pinhole = {static_cast<int>(width), static_cast<int>(height), K[0], K[4], K[2], K[5]};
  camera.distortion = *distortion;
  camera.timing = calibration::kUnknownTiming;
  return Result<calibration::CalibratedCamera>(camera);
}

std::optional<std::vector<TransformMessage>> tf_message(std::string_view data) {
  constexpr std::uint32_t kMost = 10'000;
  Values values(data);
  const auto count = values.number<std::uint32_t>();
  std::vector<TransformMessage> transforms;
  for (std::uint32_t i = 0; i < std::min(count, kMost) && !values.failed(); ++i) {
    TransformMessage transform;
    transform.header = values.header();
    transform.child_frame_id = values.bytes();
    const Vector3d t_m = values.vector();
    const Vector3d q = values.vector();
    const auto w = values.number<double>();
    const Quaterniond rotation(w, q.x(), q.y(), q.z());
    if (!t_m.allFinite() || !(rotation.norm() > 0.5 && rotation.norm() < 2)) return std::nullopt;
    transform.T_parent_child = {rotation.normalized(), t_m};
    transforms.push_back(std::move(transform));
  }
  return values.failed() ? std::nullopt : std::optional(std::move(transforms));
}

std::optional<SE3> extrinsics_message(std::string_view data) {
  // Newer versions of the driver put no header before the numbers.
  constexpr std::size_t kNumbers = 12 * 8;
  Values values(data);
  if (data.size() != kNumbers) static_cast<void>(values.header());
  std::array<double, 9> R{};
  for (double& value : R) value = values.number<double>();
  const Vector3d t_m = values.vector();
  if (values.failed()) return std::nullopt;
  const std::array<double, 12> rows = {R[0], R[3],    R[6], t_m.x(), R[1], R[4],
                                       R[7], t_m.y(), R[2], R[5],    R[8], t_m.z()};
  if (!std::ranges::all_of(rows, [](double value) { return std::isfinite(value); })) return std::nullopt;
  return calibration::rigid_transform(rows);
}

ImageKind kind_of(const ImageMessage& image) {
  if (image.width_px > 0) {
    if (is_color_encoding(image.encoding)) return ImageKind::color;
    return is_depth_encoding(image.encoding) ? ImageKind::depth : ImageKind::other;
  }
  if (image.encoding.starts_with("16UC1") || is_compressed_depth(image.encoding)) return ImageKind::depth;
  return is_compressed_color(image.encoding) ? ImageKind::color : ImageKind::other;
}

}  // namespace fusebench::formats::rosbag
