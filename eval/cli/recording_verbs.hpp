// Verbs about recordings themselves: what is in them, made ones, and their calibration.
#pragma once

#include "eval/cli/verb.hpp"

namespace fusebench {

[[nodiscard]] Verb add_simulate_verb(CLI::App& app);
[[nodiscard]] Verb add_inspect_verb(CLI::App& app);
[[nodiscard]] Verb add_calibrate_verb(CLI::App& app);
[[nodiscard]] Verb add_smooth_verb(CLI::App& app);

}  // namespace fusebench
