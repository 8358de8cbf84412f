// The part of the results' page that looks at a parameter sweep as a whole.
#pragma once

#include <span>
#include <vector>

#include "eval/compare/aggregate/run_rows.hpp"
#include "eval/page/page.hpp"

namespace fusebench::report {

/// For each kind of data: what the options do alone and in pairs, and which configurations are both accurate
/// and cheap. None if no option has several values.
[[nodiscard]] std::vector<page::PageSection> sweep_sections(std::span<const aggregate::RunRow> rows);

}  // namespace fusebench::report
