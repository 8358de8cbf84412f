// Variants of the estimator: rows of one table, each an edit of the configuration.
#pragma once

#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::config {

struct Variant {
  std::string_view name;         ///< e.g. "full"
  std::string_view paper_label;  ///< e.g. "Ours"; empty if the paper has none
  std::string_view sentence;
  std::string_view edits;      ///< "key=value key=value", as --set takes them; empty for `full`
  std::string_view base = {};  ///< the variant that is edited; empty: the defaults
};

/// All variants, in the order in which tables list them.
[[nodiscard]] std::span<const Variant> all_variants();

/// The variant of that name; the error lists all names and the nearest one.
[[nodiscard]] Result<Variant> find_variant(std::string_view name);

/// The configuration of a variant before any file or --set.
[[nodiscard]] EffectiveConfig variant_config(const Variant& variant);

/// True if the effective configuration cannot run without inertial samples.
[[nodiscard]] bool needs_imu(const Config& config);

}  // namespace fusebench::config
