// Recordings that are found by their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::suites {

/// A folder as it is named, else the folder of that name under `data` (may be empty), else the recording of
/// that name in the catalogue (datasets/calibration/recording_catalogue.hpp). Error data_missing that says
/// what is known: how to fetch a recording of the catalogue, or what is under `data`, with the nearest name.
[[nodiscard]] Result<std::filesystem::path> find_recording(const std::string& name,
                                                           const std::filesystem::path& data);

/// The same; a name that ends with * stands for all folders under `data` that begin so, by path. Error
/// data_missing.
[[nodiscard]] Result<std::vector<std::filesystem::path>> find_recordings(const std::string& name,
                                                                         const std::filesystem::path& data);

/// The folders under `data` that hold a recording of any format, directly or one level deeper
/// (<scene>/<sequence>), by path. Errors: data_missing if `data` is no folder or has none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> recordings_under(const std::filesystem::path& data);

}  // namespace fusebench::suites
