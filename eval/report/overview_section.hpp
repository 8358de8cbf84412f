// The first table of a page of runs: which method won on which recording, and by how much.
#pragma once

#include <span>
#include <string>

#include "eval/compare/findings/ranking.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/page/page.hpp"

namespace fusebench::report {

/// Recordings by methods, each cell with its range over replicates, the share of tracked frames and
/// undetected failures, and the mean ratio to the best of each recording below. Of many methods: methods by
/// recordings. A number leads to the picture of the first of its runs that has one. pictures: files, one a
/// run; empty: none. only: whether it is the page's only ranking.
[[nodiscard]] page::PageSection overview_section(const findings::Ranking& ranking,
                                                 const tables::ResultTable& table,
                                                 std::span<const std::string> pictures, bool only);

}  // namespace fusebench::report
