#include "datasets/recording/formats/icl/icl_povray_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/printable.hpp"
#include "datasets/images/file_content.hpp"

namespace fusebench::formats::icl {

namespace {

constexpr std::uintmax_t kMaxCameraFileBytes = 1 << 16;
constexpr std::uintmax_t kMaxNumberLength = 32;  // characters with a separator, on average
constexpr double kOrthogonal = 1e-3;             // the files have six digits
constexpr double kFarthest_m = 1000;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

Result<std::string> read_text(const std::filesystem::path& file, std::uintmax_t longest) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read as a file", file.string()));
  if (size > longest) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: {} bytes (at most {} expected)", file.string(), size, longest));
  }
  std::string text(size, '\0');
  std::ifstream stream = io::input_file(file);
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream) return fail(ErrorCode::data_corrupt, fmt::format("{}: read error", file.string()));
  return text;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// "[x, y, z]';" to three numbers.
std::optional<Vector3d> parse_vector(std::string_view text) {
  const std::size_t end = text.find(']');
  if (!text.starts_with('[') || end == std::string_view::npos) return std::nullopt;
  const std::string_view rest = text.substr(end + 1);
  if (rest.find_first_not_of("';") != std::string_view::npos) return std::nullopt;
  std::vector<std::string_view> fields;
  io::split_fields(text.substr(1, end - 1), fields);
  if (fields.size() != 3) return std::nullopt;
  Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const auto number = io::parse_number(fields[static_cast<std::size_t>(i)]);
    if (!number) return std::nullopt;
    vector[i] = *number;
  }
  return vector;
}

/// The vectors that make a camera, by their names in the file.
class CameraLines {
 public:
  Result<void> take(std::string_view line, const std::string& place) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return {};
    const std::string_view key = trim(line.substr(0, equals));
    const auto slot = std::ranges::find(kNames, key);
    if (slot == kNames.end()) return {};
    auto& value = values_[static_cast<std::size_t>(slot - kNames.begin())];
    if (value) return fail(ErrorCode::data_corrupt, fmt::format("{}: {} is given twice", place, key));
    value = parse_vector(trim(line.substr(equals + 1)));
    if (value) return {};
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: expected {} = [x, y, z]'; with finite numbers", place, key));
  }

  [[nodiscard]] Result<PovrayCamera> camera(const std::string& file) const {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (!values_[i]) return fail(ErrorCode::data_corrupt, fmt::format("{}: has no {}", file, kNames[i]));
    }
    return PovrayCamera{*values_[0], *values_[1], *values_[2], *values_[3]};
  }

 private:
  static constexpr std::array<std::string_view, 4> kNames = {"cam_pos", "cam_dir", "cam_up", "cam_right"};
  std::array<std::optional<Vector3d>, 4> values_;
};

Result<void> check_axes(const PovrayCamera& camera, const std::string& file) {
  Matrix3d axes;
  axes << camera.right.normalized(), camera.up.normalized(), camera.direction.normalized();
  // In a left-handed frame the numbers of x, y, z are those of a right-handed one: determinant +1.
  const double off = (axes.transpose() * axes - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off < kOrthogonal && axes.determinant() > 0) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("{}: cam_right, cam_up and cam_dir are no left-handed orthogonal axes (off by {:.3g}, "
                  "determinant {:.3g})",
                  file, off, axes.determinant()),
      "POV-Ray's cameras are left-handed; one with a negated right vector is another camera");
}

tl::unexpected<Error> bad_depth(const std::filesystem::path& file, std::string_view text, const char* at,
                                std::string_view what) {
  const auto lines = 1 + std::count(text.data(), at, '\n');
  return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: {}", file.string(), lines, what),
              "a .depth file has one decimal number a pixel");
}

/// Ray lengths, row by row.
Result<std::vector<float>> parse_lengths(const std::filesystem::path& file, std::string_view text,
                                         std::size_t count) {
  std::vector<float> lengths;
  lengths.reserve(count);
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end) break;
    if (lengths.size() == count)
      return bad_depth(file, text, at, fmt::format("more than the {} numbers of the image", count));
    float value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    const bool whole = next == end || is_blank(*next);
    if (error != std::errc() || !whole || !std::isfinite(value) || value < 0) {
      const std::string_view excerpt(at, static_cast<std::size_t>(std::min<std::ptrdiff_t>(end - at, 20)));
      return bad_depth(file, text, at,
                       fmt::format("pixel {}: expected the length of a ray, got '{}'", lengths.size(),
                                   printable(excerpt.substr(0, excerpt.find_first_of(" \t\r\n")))));
    }
    lengths.push_back(value);
    at = next;
  }
  if (lengths.size() < count)
    return bad_depth(file, text, end, fmt::format("{} numbers, expected {}", lengths.size(), count));
  return lengths;
}

}  // namespace

Result<PovrayCamera> read_povray_camera(const std::filesystem::path& file) {
  const auto text = read_text(file, kMaxCameraFileBytes);
  if (!text) return tl::unexpected(text.error());
  CameraLines lines;
  std::string_view rest = *text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    if (auto taken = lines.take(rest.substr(0, length), fmt::format("{}:{}", file.string(), line)); !taken)
      return tl::unexpected(taken.error());
    rest.remove_prefix(std::min(length + 1, rest.size()));
  }
  auto camera = lines.camera(file.string());
  if (!camera) return camera;
  if (const auto sound = check_axes(*camera, file.string()); !sound) return tl::unexpected(sound.error());
  return camera;
}

SE3 pose_of(const PovrayCamera& camera, double units_per_metre) {
  const Eigen::DiagonalMatrix<double, 3> turn_y(1, -1, 1);
  const Vector3d forward = turn_y * camera.direction.normalized();
  const Vector3d down = -(turn_y * camera.up.normalized());
  const Vector3d right = down.cross(forward).normalized();
  Matrix3d R;
  R << right, forward.cross(right), forward;
  return {Quaterniond(R).normalized(), turn_y * camera.position / units_per_metre};
}

Result<DepthImage> read_povray_depth(const std::filesystem::path& file, const PinholeCamera& camera,
                                     double units_per_metre, const std::optional<io::ContentHash>& opened) {
  const std::size_t count =
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  const auto text = read_text(file, kMaxNumberLength * (count + 1));
  if (!text) return tl::unexpected(text.error());
  if (const auto same = images::check_unchanged(file, *text, opened); !same)
    return tl::unexpected(same.error());
  const auto lengths = parse_lengths(file, *text, count);
  if (!lengths) return tl::unexpected(lengths.error());
  DepthImage depth_m(camera.width_px, camera.height_px);
  std::size_t pixel = 0;
  for (int v = 0; v < camera.height_px; ++v) {
    const double y = (v - camera.cy_px) / camera.fy_px;
    for (int u = 0; u < camera.width_px; ++u, ++pixel) {
      const double x = (u - camera.cx_px) / camera.fx_px;
      const double length_m = static_cast<double>((*lengths)[pixel]) / units_per_metre;
      depth_m.data[pixel] =
          length_m > kFarthest_m ? 0.0F : static_cast<float>(length_m / std::sqrt(x * x + y * y + 1));
    }
  }
  return depth_m;
}

}  // namespace fusebench::formats::icl
