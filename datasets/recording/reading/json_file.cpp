#include "datasets/recording/reading/json_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/io/bounded_text.hpp"
#include "core/base/printable.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/reading/text_matrix.hpp"

namespace fusebench::reading {

namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28;
constexpr double kMostPixels = 16384;

std::optional<double> number_of(const nlohmann::json& value) {
  if (!value.is_number()) return std::nullopt;
  const auto number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

tl::unexpected<Error> wrong(const std::filesystem::path& file, const std::string& what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what));
}

Result<int> pixels(const nlohmann::json& object, const std::string& key, const std::filesystem::path& file) {
  const auto number = json_number(object, key, file);
  if (!number) return tl::unexpected(number.error());
  if (*number >= 1 && *number <= kMostPixels && std::floor(*number) == *number)
    return static_cast<int>(*number);
  return wrong(file, fmt::format("{} = {} (allowed: whole numbers from 1 to {})", key, *number, kMostPixels));
}

}  // namespace

Result<nlohmann::json> read_json(const std::filesystem::path& file) {
  const auto text = io::whole_text(file, kMostBytes, "description of a recording");
  if (!text) return tl::unexpected(text.error());
  auto document = nlohmann::json::parse(*text, nullptr, false);
  if (document.is_discarded()) return wrong(file, "is not JSON, or not all of it is there");
  if (!document.is_object()) return wrong(file, "is no JSON object");
  return document;
}

Result<double> json_number(const nlohmann::json& object, const std::string& key,
                           const std::filesystem::path& file) {
  const auto found = object.find(key);
  const auto number = found == object.end() ? std::nullopt : number_of(*found);
  if (number) return *number;
  return wrong(file, fmt::format("needs the key {}, a finite number", key));
}

Result<std::vector<double>> json_numbers(const nlohmann::json& object, const std::string& key,
                                         std::size_t count, const std::filesystem::path& file) {
  std::vector<double> numbers;
  const auto found = object.find(key);
  if (found != object.end() && found->is_array() && found->size() == count) {
    for (const nlohmann::json& value : *found) {
      if (const auto number = number_of(value)) numbers.push_back(*number);
    }
    if (numbers.size() == count) return numbers;
  }
  return wrong(file, fmt::format("needs the key {}, a list of {} finite numbers", key, count));
}

Result<std::optional<double>> json_frame_rate(const nlohmann::json& object, const std::filesystem::path& file,
                                              std::vector<std::string>& warnings) {
  if (!object.contains("fps")) return std::optional<double>();
  const auto rate_hz = json_number(object, "fps", file);
  if (!rate_hz) return tl::unexpected(rate_hz.error());
  if (recording::is_frame_rate(*rate_hz)) return std::optional(*rate_hz);
  warnings.push_back(fmt::format(
      "{}: fps = {} is not used (allowed: 1 to 1000); --frame-rate gives the rate of frames without stamps",
      file.string(), *rate_hz));
  return std::optional<double>();
}

void warn_of_unused_keys(const nlohmann::json& object, std::span<const std::string_view> known,
                         const std::filesystem::path& file, std::vector<std::string>& warnings) {
  std::vector<std::string> unused;
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end()) unused.push_back(printable(key, 40));
  }
  if (!unused.empty())
    warnings.push_back(fmt::format("{}: not used: {}", file.string(), fmt::join(unused, ", ")));
}

Result<PinholeCamera> json_camera(const nlohmann::json& object, const JsonCameraKeys& keys,
                                  const std::filesystem::path& file) {
  const auto width = pixels(object, keys.width, file);
  if (!width) return tl::unexpected(width.error());
  const auto height = pixels(object, keys.height, file);
  if (!height) return tl::unexpected(height.error());
  const auto m = json_numbers(object, keys.matrix, 9, file);
  if (!m) return tl::unexpected(m.error());
  const std::array<double, 9> rows = {(*m)[0], (*m)[3], (*m)[6], (*m)[1], (*m)[4],
                                      (*m)[7], (*m)[2], (*m)[5], (*m)[8]};
  auto camera = camera_of_matrix(rows, fmt::format("{}: {}", file.string(), keys.matrix));
  if (!camera) return camera;
  camera->width_px = *width;
  camera->height_px = *height;
  return camera;
}

}  // namespace fusebench::reading
