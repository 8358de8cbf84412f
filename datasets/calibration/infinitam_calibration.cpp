#include "datasets/calibration/infinitam_calibration.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::calibration {

namespace {

constexpr std::size_t kMaxWords = 1000;  // the format has 45; a file of many more is something else

struct Word {
  std::string text;
  int line = 0;
};

Result<std::vector<Word>> words_of(const std::filesystem::path& file) {
  std::ifstream stream = io::input_file(file);
  std::error_code ignored;
  if (!stream || !std::filesystem::is_regular_file(file, ignored))
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read as a file", file.string()));
  std::vector<Word> words;
  std::vector<std::string_view> fields;
  std::string line;
  for (int number = 1; io::next_line(stream, line) && words.size() < kMaxWords; ++number) {
    std::string_view content = std::string_view(line).substr(0, line.find_first_of("%#"));
    if (number == 1 && content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);  // byte order mark
    io::split_fields(content, fields);
    for (const std::string_view field : fields) words.push_back({std::string(field), number});
  }
  return words;
}

/// Reads words in order and keeps the first error.
class Blocks {
 public:
  Blocks(std::string file, std::vector<Word> words) : file_(std::move(file)), words_(std::move(words)) {}

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  [[nodiscard]] std::size_t left() const { return words_.size() - next_; }
  [[nodiscard]] bool take_word(std::string_view text) {
    const bool there = left() > 0 && words_[next_].text == text;
    if (there) ++next_;
    return there;
  }

  double number(std::string_view what) {
    if (left() == 0) {
      report(fmt::format("{}: ends before {}", file_, what));
      return 0;
    }
    const Word& word = words_[next_++];
    const auto value = io::parse_number(word.text);
    if (!value) report(fmt::format("{}:{}: {}: {}", file_, word.line, what, value.error().message));
    return value.value_or(0);
  }

  double positive(std::string_view what, double most) {
    const double value = number(what);
    if (value > 0 && value <= most) return value;
    complain(fmt::format("{} = {} (allowed: above 0, up to {})", what, value, most));
    return 1;
  }

  double within(std::string_view what, double most) {
    const double value = number(what);
    if (std::abs(value) <= most) return value;
    complain(fmt::format("{} = {} (allowed: {} to {})", what, value, -most, most));
    return 0;
  }

  int pixels(std::string_view what) {
    const double value = positive(what, kMostSize_px);
    if (value == std::floor(value)) return static_cast<int>(value);
    complain(fmt::format("{} = {} is no whole number", what, value));
    return 1;
  }

  PinholeCamera camera(std::string_view name) {
    PinholeCamera camera;
    camera.width_px = pixels(fmt::format("{} width", name));
    camera.height_px = pixels(fmt::format("{} height", name));
    camera.fx_px = positive(fmt::format("{} fx", name), 1e6);
    camera.fy_px = positive(fmt::format("{} fy", name), 1e6);
    camera.cx_px = within(fmt::format("{} cx", name), 1e6);
    camera.cy_px = within(fmt::format("{} cy", name), 1e6);
    return camera;
  }

  SE3 transform(std::string_view name) {
    std::array<double, 12> rows{};
    for (double& value : rows) value = number(name);
    const auto T = rigid_transform(rows);
    if (!T) complain(fmt::format("{} is no rigid transform ({})", name, kRigidTransformRule));
    if (T && T->translation.cwiseAbs().maxCoeff() > kMostLeverArm_m)
      complain(fmt::format("{} has a translation of {:g} m (allowed up to {} m)", name,
                           T->translation.cwiseAbs().maxCoeff(), kMostLeverArm_m));
    return T.value_or(SE3{});
  }

  /// About the word that was read last.
  void complain(std::string_view what) {
    report(fmt::format("{}:{}: {}", file_, words_.empty() ? 0 : words_[next_ - 1].line, what));
  }

 private:
  void report(std::string message) {
    if (!error_)
      error_ = Error{ErrorCode::data_corrupt, std::move(message),
                     "see the layout of calib.txt in docs/datasets.md"};
  }

  std::string file_;
  std::vector<Word> words_;
  std::size_t next_ = 0;
  std::optional<Error> error_;
};

double depth_units_per_metre(Blocks& blocks) {
  if (!blocks.take_word("affine")) {
    static_cast<void>(blocks.number("the depth scale ('affine', scale, offset)"));
    blocks.complain("the depth scale must be 'affine', scale, offset");
    return 1;
  }
  const double scale = blocks.positive("depth scale (metres per unit)", 1 / kLeastUnits_per_m);
  if (blocks.number("depth offset") != 0) blocks.complain("the offset of depth must be 0");
  return 1 / scale;
}

ImuNoise noise(Blocks& blocks) {
  ImuNoise noise;
  noise.accelerometer_bias_mps3_sqrthz =
      std::sqrt(blocks.positive("variance of the accelerometer's bias", 1e4));
  noise.accelerometer_mps2_sqrthz = std::sqrt(blocks.positive("variance of the accelerometer", 1e4));
  noise.gyroscope_bias_radps2_sqrthz = std::sqrt(blocks.positive("variance of the gyroscope's bias", 1e4));
  noise.gyroscope_radps_sqrthz = std::sqrt(blocks.positive("variance of the gyroscope", 1e4));
  return noise;
}

}  // namespace

Result<RigCalibration> read_infinitam_calibration(const std::filesystem::path& file) {
  auto words = words_of(file);
  if (!words) return tl::unexpected(words.error());
  Blocks blocks(file.string(), std::move(*words));
  RigCalibration calibration;
  calibration.color.pinhole = blocks.camera("colour");
  calibration.depth.emplace();
  calibration.depth->pinhole = blocks.camera("depth");
  calibration.depth->T_color_depth = blocks.transform("T_color_depth");
  constexpr std::size_t kScaleWords = 3;
  if (blocks.left() > kScaleWords) {
    const SE3 T_imu_depth = blocks.transform("T_imu_depth");
    calibration.depth_units_per_metre = depth_units_per_metre(blocks);
    const SE3 T_imu_camera = T_imu_depth * calibration.depth->T_color_depth.inverse();
    calibration.imu = ImuCalibration{T_imu_camera, noise(blocks), 0};
  } else {
    calibration.depth_units_per_metre = depth_units_per_metre(blocks);
  }
  if (!blocks.error() && blocks.left() > 0) blocks.complain("there are more numbers after the last block");
  if (blocks.error()) return tl::unexpected(*blocks.error());
  return calibration;
}

}  // namespace fusebench::calibration
