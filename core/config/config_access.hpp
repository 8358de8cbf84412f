// Reading and writing a Config by key, with the origin of every value.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/config/options.hpp"

namespace fusebench::config {

/// All options in declaration order, with their current values.
[[nodiscard]] std::vector<OptionRow> describe_options(const Config& config);

/// Sets one option. Errors (ErrorCode::configuration) name the key, the value, the allowed range, and for an
/// unknown key the nearest one.
[[nodiscard]] Result<void> set_option(Config& config, std::string_view key, const OptionValue& value);

/// Checks relations between options (e.g. depth.min_m < depth.max_m).
[[nodiscard]] Result<void> check_relations(const Config& config);

/// A configuration and where each value that is not the default came from.
class EffectiveConfig {
 public:
  EffectiveConfig();  ///< the defaults
  EffectiveConfig(const EffectiveConfig& other);
  EffectiveConfig(EffectiveConfig&& other) noexcept;
  EffectiveConfig& operator=(const EffectiveConfig& other);
  EffectiveConfig& operator=(EffectiveConfig&& other) noexcept;
  ~EffectiveConfig();

  [[nodiscard]] const Config& values() const { return *values_; }
  [[nodiscard]] Config& values() { return *values_; }

  std::map<std::string, std::string>
      origins;  ///< key -> "variant dm", "my.toml:12", "--set"; absent = default

  [[nodiscard]] std::string origin(const std::string& key) const {
    const auto found = origins.find(key);
    return found == origins.end() ? "default" : found->second;
  }
  /// set_option() that records the origin and puts it into the error message.
  [[nodiscard]] Result<void> set(std::string_view key, const OptionValue& value, const std::string& origin);
  /// "key=value", as `--set` takes it.
  [[nodiscard]] Result<void> set_assignment(std::string_view assignment);

 private:
  std::unique_ptr<Config> values_;  // held by pointer, so that few sources depend on the list of options
};

/// Parses an untyped value: true/false, integer, number, else text.
[[nodiscard]] OptionValue parse_option_value(std::string_view text);

/// Applies a TOML file whose tables mirror the options ([iekf] max_iterations = 8). Strict: an unknown key or
/// wrong type is an error with file and line.
[[nodiscard]] Result<void> apply_config_file(EffectiveConfig& config, const std::filesystem::path& file);

/// 16 hexadecimal digits that identify the values (not their origins).
[[nodiscard]] std::string config_hash(const Config& config);

}  // namespace fusebench::config
