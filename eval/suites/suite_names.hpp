// Suites that are found by their names.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::suites {

/// The files of suites in a folder of configurations, sorted. Error data_missing,
/// where shipped_configs() has found none with the places where it looked.
[[nodiscard]] Result<std::vector<std::filesystem::path>> suite_files(const std::filesystem::path& configs);

/// configs/ in the working folder or above it, else above the program; share/fusebench/configs where it is
/// installed. Empty if there is none.
[[nodiscard]] std::filesystem::path shipped_configs();

/// The file that a command line calls by `name`: a file of that path, else configs/suites/<name>.toml. Error
/// data_missing, with the nearest name.
[[nodiscard]] Result<std::filesystem::path> find_suite(
    const std::filesystem::path& name, const std::filesystem::path& configs = shipped_configs());

}  // namespace fusebench::suites
