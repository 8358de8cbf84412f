// Verbs on recordings: inspection, simulation, conversion and calibration.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::recordings {

[[nodiscard]] console::Verb add_simulate_verb(CLI::App& app);
[[nodiscard]] console::Verb add_inspect_verb(CLI::App& app);
[[nodiscard]] console::Verb add_export_verb(CLI::App& app);
[[nodiscard]] console::Verb add_convert_verb(CLI::App& app);
[[nodiscard]] console::Verb add_calibrate_verb(CLI::App& app);
[[nodiscard]] console::Verb add_prepare_verb(CLI::App& app);
[[nodiscard]] console::Verb add_smooth_verb(CLI::App& app);

}  // namespace fusebench::cli::recordings
