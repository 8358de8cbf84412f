// What a record says of the camera, as JSON with the keys of calibration.toml.
#pragma once

#include <nlohmann/json.hpp>

#include "eval/record/record.hpp"

namespace fusebench::record {

/// The value of "camera": the tables "color" and "depth".
[[nodiscard]] nlohmann::ordered_json json_of_camera(const RecordedCamera& camera);

/// Throws the exceptions of the JSON library for what is missing, and std::invalid_argument for a number
/// that no calibration may have: it may be used to read images.
[[nodiscard]] RecordedCamera camera_of(const nlohmann::ordered_json& json);

}  // namespace fusebench::record
