// JSON files of recordings.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::reading {

/// The file's object. Errors: data_missing, data_corrupt (no JSON, no object).
[[nodiscard]] Result<nlohmann::json> read_json(const std::filesystem::path& file);

/// A number of an object, `count` numbers of a list. Error data_corrupt, with file and key: not there,
/// another type or length, not finite.
[[nodiscard]] Result<double> json_number(const nlohmann::json& object, const std::string& key,
                                         const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<double>> json_numbers(const nlohmann::json& object, const std::string& key,
                                                       std::size_t count, const std::filesystem::path& file);

/// The key fps. Nothing if it is not there, or, with a warning, if it is no frame rate: recorders that do not
/// know it write 0. Error data_corrupt: not a finite number.
[[nodiscard]] Result<std::optional<double>> json_frame_rate(const nlohmann::json& object,
                                                            const std::filesystem::path& file,
                                                            std::vector<std::string>& warnings);

/// Warns of the keys of an object that are not among `known`: they are not used.
void warn_of_unused_keys(const nlohmann::json& object, std::span<const std::string_view> known,
                         const std::filesystem::path& file, std::vector<std::string>& warnings);

/// A camera of the keys of its width and height and of its matrix K, nine numbers column by column. Errors:
/// those of json_numbers; data_corrupt (a size that is no whole number from 1 to 16384, no camera's matrix).
struct JsonCameraKeys {
  std::string width;
  std::string height;
  std::string matrix;
};
[[nodiscard]] Result<PinholeCamera> json_camera(const nlohmann::json& object, const JsonCameraKeys& keys,
                                                const std::filesystem::path& file);

}  // namespace fusebench::reading
