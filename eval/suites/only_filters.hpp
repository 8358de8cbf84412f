// What --only says: which runs of a suite are requested.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::suites {

/// Each is "recording=TEXT", "variant=NAME" or "split=NAME"; of those of one key any, of all keys each has to
/// be met.
using OnlyFilters = std::vector<std::string>;

/// Whether they can leave a run of that variant.
[[nodiscard]] bool variant_may_be_wanted(const OnlyFilters& only, std::string_view variant);

/// Whether they can leave something of a recording that the suite calls by that name ("begin*" as well).
[[nodiscard]] bool recording_may_be_wanted(const OnlyFilters& only, std::string_view name);

/// Error usage: another key or a wrong value, with the nearest key.
[[nodiscard]] Result<void> check_filters(const OnlyFilters& only);

/// Whether a job is among those asked for, by filters that check_filters() has seen.
[[nodiscard]] bool wanted(const OnlyFilters& only, const std::string& recording, const std::string& split,
                          const std::string& variant);

/// Error usage: a variant that is none of the suite's, with the nearest and all of them.
[[nodiscard]] Result<void> check_variants(const OnlyFilters& only, const std::string& suite,
                                          std::vector<std::string> variants);

/// Error usage: a recording that is none of the suite's, with the nearest and all of them. recordings: names,
/// or their known beginnings ("begin*").
[[nodiscard]] Result<void> check_recordings(const OnlyFilters& only, const std::string& suite,
                                            std::vector<std::string> recordings);

}  // namespace fusebench::suites
