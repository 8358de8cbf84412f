// The few numbers of a record that aggregations need, without building the whole document.
#pragma once

#include <string_view>

#include "eval/aggregate/run_rows.hpp"

namespace fusebench {

/// A row without `run` and `folder`. Text that is no record gives a row that is not readable, failed, with
/// the reason and with what was read of recording and variant before the damage.
[[nodiscard]] RunRow scan_record(std::string_view json);

}  // namespace fusebench
