// Options that several verbs take, declared once.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "eval/run/run.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::console {

void add_data_option(CLI::App& verb, std::filesystem::path& data);    ///< --data, default FUSEBENCH_DATA
void add_threads_option(CLI::App& verb, int& threads);                ///< --threads, default all
void add_set_option(CLI::App& verb, std::vector<std::string>& sets);  ///< --set key=value
void add_config_option(CLI::App& verb, std::filesystem::path& file);  ///< --config FILE
void add_variant_option(CLI::App& verb, std::string& variant);        ///< --variant, default full
void add_profile_flag(CLI::App& verb, bool& profile);                 ///< --profile
void add_json_flag(CLI::App& verb, bool& json);                       ///< --json

/// The variant's configuration, then the file's (may be empty), then --set; relations checked.
[[nodiscard]] Result<config::EffectiveConfig> effective_config(const std::string& variant,
                                                               const std::filesystem::path& file,
                                                               const std::vector<std::string>& sets);

/// "A:B" to frames A to B-1, "A:" to all from A on, ":B" to the first B; nothing for an empty text. Error
/// usage.
[[nodiscard]] Result<std::optional<run::FrameWindow>> parse_frames(const std::string& text);

}  // namespace fusebench::cli::console
