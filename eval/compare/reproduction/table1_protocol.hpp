// What `fusebench reproduce table1` runs (configs/reproduction/): the readings of the paper's Table 1, and
// the recordings that stand for its rows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::reproduction {

/// A pair of variants that "DM" and "Ours" may mean.
struct Reading {
  std::string name;
  std::string sentence;
  std::string speaks_for;  ///< what in the paper's text does; empty in the factorial
  std::string speaks_against;
  std::string dm = "dm";
  std::string ours = "full";
  std::vector<std::string> set;     ///< key=value, of both
  std::vector<std::string> set_dm;  ///< and of dm alone
  bool factorial = false;
};

/// Recordings that stand for a row of the paper's table.
struct Column {
  std::string group;
  std::string row;  ///< the label of the published row
  std::string is;   ///< what they are
};

struct Table1Protocol {
  std::vector<Column> columns;
  std::vector<Reading> readings;  ///< those of the factorial last
};

/// Name and content of each file of configs/reproduction/. Defined by a generated source.
struct ReproductionFile {
  const char* file;
  const char* text;
};
[[nodiscard]] std::span<const ReproductionFile> reproduction_files();

/// Errors: configuration, with file:line.
[[nodiscard]] Result<Table1Protocol> parse_table1_protocol(std::string_view text, const std::string& file);

/// That of the binary.
[[nodiscard]] Result<Table1Protocol> table1_protocol();
/// Its recordings.
[[nodiscard]] Result<suites::Suite> table1_suite();
/// The recordings and variants of the paper's figures.
[[nodiscard]] Result<suites::Suite> figures_suite();

}  // namespace fusebench::reproduction
