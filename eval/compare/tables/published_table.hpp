// Published numbers of others (configs/paper/), shown next to those of runs here.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/registry/run_metric.hpp"

namespace fusebench::tables {

struct PublishedRow {
  std::string group;
  std::string label;      ///< the source's name of the recording
  std::string recording;  ///< its name in the catalogue; empty: not available
  std::vector<std::optional<double>>
      published;  ///< one a system, in the unit of the value; absent: not given
};

struct PublishedTable {
  std::string name;
  std::string title;
  std::string source;
  bool verified = false;  ///< read again in the source itself
  std::string note;
  const registry::RunMetric* value = nullptr;  ///< the number of a run here that is shown next to it
  std::vector<std::string> systems;
  std::vector<std::string> variants = {"full"};  ///< run here; with `ratio` in the order of the systems
  bool ratio = false;                            ///< the first system or variant over the last
  std::vector<PublishedRow> rows;
};

/// Reads one file. Error configuration, with file:line: bad syntax, an unknown or missing key, a value of the
/// wrong type, a value that runs do not have, or rows with another number of systems.
[[nodiscard]] Result<PublishedTable> parse_published_table(std::string_view text, const std::string& file);

/// The tables of configs/paper/, by name. Error usage for another name, with the names that there are.
[[nodiscard]] Result<PublishedTable> published_table(std::string_view name);

/// Name and content of each file of configs/paper/, by name. Defined by a generated source.
struct PublishedFile {
  const char* file;
  const char* text;
};
[[nodiscard]] std::span<const PublishedFile> published_files();

}  // namespace fusebench::tables
