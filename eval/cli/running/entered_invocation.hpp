// Reads the stored invocation of a suite and enters its folder.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "eval/suites/engine/invocation.hpp"

namespace fusebench::cli::running {

/// Reads the file and enters the folder in which the command was given: folders in it are relative to that.
/// Errors: those of read_invocation(); data_missing if the folder cannot be entered.
[[nodiscard]] Result<engine::Invocation> enter_invocation(const std::filesystem::path& file);

}  // namespace fusebench::cli::running
