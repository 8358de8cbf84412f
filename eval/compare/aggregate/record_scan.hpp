// The few numbers of a record that aggregations need, without building the whole document.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::aggregate {

/// A row without `run` and `folder`. Text that is no record gives a row that is not readable, failed, with
/// the reason and with what was read of recording and variant before the damage. The names and sizes of the
/// files that stand in the record (without hashes) are added to `files`, if there is one.
[[nodiscard]] RunRow scan_record(std::string_view json, std::vector<record::RecordedFile>* files = nullptr);

/// The row of a run that is not whole: failed, without numbers and options. What its record says of its data
/// and their truth stays.
[[nodiscard]] RunRow damaged_row(RunRow row, std::string reason);

/// The row of a run whose record is lost: of which kind its data and their truth are is not known either.
[[nodiscard]] RunRow row_without_record(RunRow row, std::string reason);

}  // namespace fusebench::aggregate
