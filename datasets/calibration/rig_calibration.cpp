#include "datasets/calibration/rig_calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <system_error>
#include <vector>

#include "core/base/nearest_name.hpp"
#include "core/base/solvers.hpp"

namespace fusebench::calibration {

namespace {

constexpr std::array<std::string_view, 10> kColorKeys = {
    "width_px", "height_px",  "fx_px",     "fy_px",           "cx_px",
    "cy_px",    "distortion", "readout_s", "readout_sigma_s", "ground_truth_offset_m"};
constexpr std::array<std::string_view, 12> kDepthKeys = {
    "units_per_metre", "width_px",      "height_px", "fx_px",           "fy_px",   "cx_px",
    "cy_px",           "T_color_depth", "readout_s", "readout_sigma_s", "delay_s", "delay_sigma_s"};
constexpr std::array<std::string_view, 7> kDepthCameraKeys = {
    "width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px", "T_color_depth"};
constexpr std::array<std::string_view, 9> kImuKeys = {"T_imu_color",
                                                      "T_imu_depth",
                                                      "gyroscope_noise_radps_sqrthz",
                                                      "accelerometer_noise_mps2_sqrthz",
                                                      "gyroscope_bias_walk_radps2_sqrthz",
                                                      "accelerometer_bias_walk_mps3_sqrthz",
                                                      "time_offset_s",
                                                      "gyroscope_scale",
                                                      "accelerometer_scale"};

struct Range {
  double least;
  double most;
};
constexpr Range kPixels{1e-3, 1e6};
constexpr Range kCentre{-1e6, 1e6};
constexpr Range kSize{1, kMostSize_px};
constexpr Range kWhiteNoise{1e-9, 100};  // a sensor without noise would override all others
constexpr Range kWalk{0, 100};
constexpr Range kReadout{0, kMostReadout_s};
constexpr Range kDelay{-kMostDelay_s, kMostDelay_s};  // also of the IMU's stamps
constexpr Range kScale{0.5, 2};

/// One of the three tables: its entries by key, and the first error.
class Section {
 public:
  Section(const config::TomlDocument& document, std::string name, const std::string& file)
      : name_(std::move(name)), place_(file) {
    const std::string prefix = name_ + ".";
    for (const config::TomlEntry& entry : document.entries) {
      if (entry.key.starts_with(prefix)) entries_[entry.key.substr(prefix.size())] = &entry;
    }
    there_ = !entries_.empty();
    for (const config::TomlTable& table : document.tables) {
      if (table.key != name_) continue;
      there_ = true;
      place_ = table.place;
    }
  }

  [[nodiscard]] bool is_there() const { return there_; }
  [[nodiscard]] bool has(const std::string& key) const { return entries_.contains(key); }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  void allow(std::span<const std::string_view> keys) {
    for (const auto& [key, entry] : entries_) {
      if (std::ranges::find(keys, key) != keys.end()) continue;
      report(fmt::format("{}: unknown key '{}'{}", entry->place, entry->key, nearest_hint(key, keys)),
             fmt::format("keys of [{}] are {}", name_, fmt::join(keys, ", ")));
    }
  }

  [[nodiscard]] double number(const std::string& key, Range range, std::optional<double> absent = {}) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) {
      if (!absent) complain(fmt::format("[{}] needs the key {}", name_, key));
      return absent.value_or(0);
    }
    const auto value = number_of(std::get_if<config::OptionValue>(&found->second->value));
    if (value && *value >= range.least && *value <= range.most) return *value;
    report(fmt::format("{}: {} must be a number from {} to {}", found->second->place, found->second->key,
                       range.least, range.most),
           {});
    return range.least;
  }

  [[nodiscard]] double units_per_metre(const std::string& key) {
    const double value = number(key, {0, kMostUnits_per_m});
    if (!is_units_per_metre(value)) {
      const Error error = no_units_per_metre(ErrorCode::configuration, entries_.at(key)->key, value).value();
      report(fmt::format("{}: {}", entries_.at(key)->place, error.message), error.hint);
    }
    return value;
  }

  [[nodiscard]] int pixels(const std::string& key) {
    const double value = number(key, kSize);
    if (value != std::floor(value))
      report(fmt::format("{}: {} must be a whole number", entries_.at(key)->place, entries_.at(key)->key),
             {});
    return static_cast<int>(value);
  }

  /// A list of exactly `count` numbers; empty if the key is not there.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return {};
    std::vector<double> values;
    if (const auto* list = std::get_if<config::TomlList>(&found->second->value)) {
      for (const config::OptionValue& value : *list) {
        if (const auto number = number_of(&value)) values.push_back(*number);
      }
      if (values.size() == count && list->size() == count) return values;
    }
    report(fmt::format("{}: {} must be a list of {} finite numbers", found->second->place, found->second->key,
                       count),
           {});
    return {};
  }

  /// Zero if the key is not there.
  [[nodiscard]] Vector3d translation(const std::string& key) {
    const std::vector<double> xyz = numbers(key, 3);
    if (xyz.empty()) return Vector3d::Zero();
    const Vector3d offset_m(xyz[0], xyz[1], xyz[2]);
    if (offset_m.cwiseAbs().maxCoeff() > kMostLeverArm_m) {
      report(fmt::format("{}: {} has a component of {:g} m (allowed up to {} m)", entries_.at(key)->place,
                         entries_.at(key)->key, offset_m.cwiseAbs().maxCoeff(), kMostLeverArm_m),
             "offsets are in metres");
    }
    return offset_m;
  }

  /// Ones if the key is not there.
  [[nodiscard]] Vector3d scale(const std::string& key) {
    const std::vector<double> xyz = numbers(key, 3);
    if (xyz.empty()) return Vector3d::Ones();
    const Vector3d scale(xyz[0], xyz[1], xyz[2]);
    if (scale.minCoeff() < kScale.least || scale.maxCoeff() > kScale.most) {
      report(fmt::format("{}: the numbers of {} must be from {} to {}", entries_.at(key)->place,
                         entries_.at(key)->key, kScale.least, kScale.most),
             "a scale of 1 leaves an axis as it is");
      return Vector3d::Ones();
    }
    return scale;
  }

  [[nodiscard]] SE3 transform(const std::string& key) {
    const std::vector<double> rows = numbers(key, 12);
    if (rows.empty()) return {};
    const double farthest_m = std::max({std::abs(rows[3]), std::abs(rows[7]), std::abs(rows[11])});
    if (farthest_m > kMostLeverArm_m) {
      report(fmt::format("{}: {} has a translation of {:g} m (allowed up to {} m)", entries_.at(key)->place,
                         entries_.at(key)->key, farthest_m, kMostLeverArm_m),
             "translations are in metres");
    }
    const auto T = rigid_transform(std::span<const double, 12>(rows));
    if (!T) {
      report(fmt::format("{}: {} is no rigid transform", entries_.at(key)->place, entries_.at(key)->key),
             fmt::format("a matrix is {}, translation in metres", kRigidTransformRule));
    }
    return T.value_or(SE3{});
  }

  /// About the table as a whole.
  void complain(std::string_view what) { report(fmt::format("{}: {}", place_, what), {}); }

  void report(std::string message, std::string hint) {
    if (!error_) error_ = Error{ErrorCode::configuration, std::move(message), std::move(hint)};
  }

 private:
  static std::optional<double> number_of(const config::OptionValue* value) {
    if (value == nullptr) return std::nullopt;
    if (const auto* integer = std::get_if<std::int64_t>(value)) return static_cast<double>(*integer);
    const auto* real = std::get_if<double>(value);
    return real != nullptr && std::isfinite(*real) ? std::optional<double>(*real) : std::nullopt;
  }

  std::string name_;
  std::string place_;  ///< of the table's header, or the file
  bool there_ = false;
  std::map<std::string, const config::TomlEntry*> entries_;
  std::optional<Error> error_;
};

/// Width and height are both given or both left out (0).
PinholeCamera read_pinhole(Section& section, bool size_needed) {
  PinholeCamera camera;
  if (section.has("width_px") || section.has("height_px") || size_needed) {
    camera.width_px = section.pixels("width_px");
    camera.height_px = section.pixels("height_px");
  }
  camera.fx_px = section.number("fx_px", kPixels);
  camera.fy_px = section.number("fy_px", kPixels);
  camera.cx_px = section.number("cx_px", kCentre);
  camera.cy_px = section.number("cy_px", kCentre);
  return camera;
}

/// What is said is exact unless it says otherwise.
double sigma_of(Section& section, const std::string& name, const Range& range, double unknown) {
  const double otherwise = section.has(name + "_s") ? 0.0 : unknown;
  return section.number(name + "_sigma_s", {0.0, range.most}, otherwise);
}

CalibratedCamera read_color_table(Section& section) {
  CalibratedCamera camera;
  section.allow(kColorKeys);
  camera.pinhole = read_pinhole(section, false);
  if (const auto k = section.numbers("distortion", 5); !k.empty())
    camera.distortion = {k[0], k[1], k[2], k[3], k[4]};
  camera.timing.color_readout_s = section.number("readout_s", kReadout, kUnknownReadout_s);
  camera.timing.color_readout_sigma_s = sigma_of(section, "readout", kReadout, kUnknownReadoutSigma_s);
  camera.ground_truth_offset_m = section.translation("ground_truth_offset_m");
  return camera;
}

void read_depth_table(Section& section, RigCalibration& calibration) {
  section.allow(kDepthKeys);
  if (section.has("units_per_metre"))
    calibration.depth_units_per_metre = section.units_per_metre("units_per_metre");
  SensorTiming& timing = calibration.color.timing;
  timing.depth_readout_s = section.number("readout_s", kReadout, kUnknownReadout_s);
  timing.depth_readout_sigma_s = sigma_of(section, "readout", kReadout, kUnknownReadoutSigma_s);
  timing.depth_delay_s = section.number("delay_s", kDelay, 0.0);
  timing.depth_delay_sigma_s = sigma_of(section, "delay", kDelay, kUnknownDelaySigma_s);
  const bool own_camera = std::ranges::any_of(
      kDepthCameraKeys, [&](std::string_view key) { return section.has(std::string(key)); });
  if (!own_camera) return;
  calibration.depth = DepthCamera{read_pinhole(section, true), section.transform("T_color_depth")};
  if (!section.has("T_color_depth"))
    section.complain(
        "[depth] with intrinsics needs T_color_depth as well; leave out both if depth is registered");
}

ImuCalibration read_imu_table(Section& section, const std::optional<DepthCamera>& depth) {
  section.allow(kImuKeys);
  ImuCalibration imu;
  if (section.has("T_imu_color") == section.has("T_imu_depth")) {
    section.complain("[imu] needs either T_imu_color or T_imu_depth");
  } else if (section.has("T_imu_color")) {
    imu.T_imu_camera = section.transform("T_imu_color");
  } else if (!depth) {
    section.complain("[imu] T_imu_depth needs a depth camera of its own ([depth] with T_color_depth)");
  } else {
    imu.T_imu_camera = section.transform("T_imu_depth") * depth->T_color_depth.inverse();
    if (imu.T_imu_camera.translation.cwiseAbs().maxCoeff() > kMostLeverArm_m)
      section.complain(fmt::format("the IMU is more than {} m from the colour camera", kMostLeverArm_m));
  }
  imu.noise.gyroscope_radps_sqrthz = section.number("gyroscope_noise_radps_sqrthz", kWhiteNoise);
  imu.noise.accelerometer_mps2_sqrthz = section.number("accelerometer_noise_mps2_sqrthz", kWhiteNoise);
  imu.noise.gyroscope_bias_radps2_sqrthz = section.number("gyroscope_bias_walk_radps2_sqrthz", kWalk);
  imu.noise.accelerometer_bias_mps3_sqrthz = section.number("accelerometer_bias_walk_mps3_sqrthz", kWalk);
  imu.time_offset_s = section.number("time_offset_s", kDelay, 0.0);
  imu.gyroscope_scale = section.scale("gyroscope_scale");
  imu.accelerometer_scale = section.scale("accelerometer_scale");
  return imu;
}

}  // namespace

tl::unexpected<Error> no_units_per_metre(ErrorCode code, std::string_view name, double value) {
  return fail(code,
              fmt::format("{} = {} (allowed: {} to {} units per metre)", name, value, kLeastUnits_per_m,
                          kMostUnits_per_m),
              is_units_per_metre(1 / value)
                  ? fmt::format("{} metres per unit are {:.6g} units per metre", value, 1 / value)
                  : "");
}

std::optional<SE3> rigid_transform(std::span<const double, 12> rows) {
  Matrix3d R;
  R << rows[0], rows[1], rows[2], rows[4], rows[5], rows[6], rows[8], rows[9], rows[10];
  const double skew = (R * R.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < 1e-3 && R.determinant() > 0)) return std::nullopt;
  const double farthest_m = std::max({std::abs(rows[3]), std::abs(rows[7]), std::abs(rows[11])});
  if (!(farthest_m <= kMostTranslation_m)) return std::nullopt;
  const Eigen::JacobiSVD<Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  return SE3{Quaterniond(nearest).normalized(), {rows[3], rows[7], rows[11]}};
}

std::optional<SE3> rigid_transform(std::span<const double, 16> rows) {
  constexpr double kTolerance = 1e-6;
  const Eigen::Map<const Eigen::RowVector4d> last(rows.data() + 12);
  if (!((last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kTolerance)) return std::nullopt;
  return rigid_transform(rows.first<12>());
}

Result<RigCalibration> rig_calibration(const config::TomlDocument& document, const std::string& file) {
  RigCalibration calibration;
  for (const config::TomlEntry& entry : document.entries) {
    if (entry.key != "calibration_source") continue;
    const auto* value = std::get_if<config::OptionValue>(&entry.value);
    const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(value);
    if (text == nullptr)
      return fail(ErrorCode::configuration, fmt::format("{}: {} must be a text", entry.place, entry.key));
    calibration.source = *text;
  }
  Section color(document, "color", file);
  calibration.color = read_color_table(color);
  if (color.error()) return tl::unexpected(*color.error());
  Section depth(document, "depth", file);
  if (depth.is_there()) read_depth_table(depth, calibration);
  if (depth.error()) return tl::unexpected(*depth.error());
  Section imu(document, "imu", file);
  if (imu.is_there()) calibration.imu = read_imu_table(imu, calibration.depth);
  if (imu.error()) return tl::unexpected(*imu.error());
  return calibration;
}

Result<RigCalibration> read_calibration(const std::filesystem::path& file) {
  const auto document = config::read_toml(file);
  if (!document) return tl::unexpected(document.error());
  for (const config::TomlEntry& entry : document->entries) {
    const bool known = entry.key == "calibration_source" || entry.key.starts_with("color.") ||
                       entry.key.starts_with("depth.") || entry.key.starts_with("imu.");
    if (!known) {
      return fail(ErrorCode::configuration, fmt::format("{}: unknown key '{}'", entry.place, entry.key),
                  "a calibration has calibration_source and the tables [color], [depth] and [imu]");
    }
  }
  return rig_calibration(*document, file.string());
}

Result<void> check_readable(const std::string& toml, const std::string& file) {
  const auto document = config::parse_toml(toml, file);
  if (!document) return tl::unexpected(document.error());
  const auto calibration = rig_calibration(*document, file);
  if (calibration) return {};
  Error error = calibration.error();
  error.message = "not written, since it could not be read: " + error.message;
  return tl::unexpected(std::move(error));
}

Result<std::optional<RigCalibration>> read_calibration_beside(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "calibration.toml";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::optional<RigCalibration>{};
  auto calibration = read_calibration(file);
  if (calibration) return std::optional<RigCalibration>(std::move(*calibration));
  // The file is part of the recording, not of the command line.
  calibration.error().code = ErrorCode::data_corrupt;
  return tl::unexpected(calibration.error());
}

}  // namespace fusebench::calibration
