#include "eval/compare/reproduction/table1_protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/config/toml_document.hpp"
#include "eval/suites/suite_entries.hpp"

namespace fusebench::reproduction {

namespace {

/// One level of one factor of the factorial.
struct FactorLevel {
  std::string factor;
  std::string level;
  std::vector<std::string> set;
};

/// Where the texts and lists of a table go.
struct Targets {
  std::vector<std::pair<std::string_view, std::string*>> texts;
  std::vector<std::pair<std::string_view, std::vector<std::string>*>> lists;
};

template <class T>
T* target_of(const std::vector<std::pair<std::string_view, T*>>& targets, std::string_view key) {
  const auto found = std::ranges::find(targets, key, [](const auto& target) { return target.first; });
  return found == targets.end() ? nullptr : found->second;
}

Result<void> read_table(const suites::EntryTable& table, std::string_view what, const Targets& targets) {
  std::vector<std::string_view> keys;
  for (const auto& target : targets.texts) keys.push_back(target.first);
  for (const auto& target : targets.lists) keys.push_back(target.first);
  for (const config::TomlEntry& entry : table.entries) {
    if (std::string* text = target_of(targets.texts, entry.key)) {
      auto value = suites::text_entry(entry);
      if (!value) return tl::unexpected(value.error());
      *text = std::move(*value);
    } else if (std::vector<std::string>* list = target_of(targets.lists, entry.key)) {
      auto value = suites::names_entry(entry);
      if (!value) return tl::unexpected(value.error());
      *list = std::move(*value);
    } else {
      return suites::unknown_key(entry.place, entry.key, keys, what);
    }
  }
  return {};
}

/// Every level of a factor with every level of the others; the first factor changes slowest.
std::vector<Reading> factorial(const std::vector<FactorLevel>& levels) {
  std::vector<Reading> readings(levels.empty() ? 0 : 1);
  std::vector<std::string_view> done;
  for (const FactorLevel& first : levels) {
    if (std::ranges::find(done, first.factor) != done.end()) continue;
    done.push_back(first.factor);
    std::vector<Reading> product;
    for (const Reading& reading : readings) {
      for (const FactorLevel& level : levels) {
        if (level.factor != first.factor) continue;
        Reading next = reading;
        next.name += (next.name.empty() ? "" : ", ") + level.level;
        next.set.insert(next.set.end(), level.set.begin(), level.set.end());
        product.push_back(std::move(next));
      }
    }
    readings = std::move(product);
  }
  for (Reading& reading : readings) {
    reading.factorial = true;
    reading.sentence = "both methods with: " + reading.name;
  }
  return readings;
}

Result<void> check_whole(const Table1Protocol& protocol, const std::string& file) {
  for (const Column& column : protocol.columns) {
    if (column.group.empty() || column.row.empty() || column.is.empty())
      return fail(ErrorCode::configuration, fmt::format("{}: a column needs group, row and is", file));
  }
  for (const Reading& reading : protocol.readings) {
    if (reading.name.empty() || reading.sentence.empty())
      return fail(ErrorCode::configuration, fmt::format("{}: a reading needs a name and a sentence", file));
    for (const std::string& variant : {reading.dm, reading.ours}) {
      if (const auto known = config::find_variant(variant); !known)
        return fail(ErrorCode::configuration,
                    fmt::format("{}: reading '{}': {}", file, reading.name, known.error().message));
    }
  }
  return {};
}

Result<std::string_view> text_of(std::string_view file) {
  for (const ReproductionFile& embedded : reproduction_files()) {
    if (embedded.file == file) return embedded.text;
  }
  return fail(ErrorCode::configuration, fmt::format("{} is not part of this build", file));
}

constexpr std::string_view kReadings = "configs/reproduction/table1_readings.toml";
constexpr std::string_view kRecordings = "configs/reproduction/table1_recordings.toml";
constexpr std::string_view kFigures = "configs/reproduction/figures_recordings.toml";

Result<suites::Suite> embedded_suite(std::string_view file) {
  const auto text = text_of(file);
  if (!text) return tl::unexpected(text.error());
  return suites::parse_suite(*text, std::string(file));
}

}  // namespace

Result<Table1Protocol> parse_table1_protocol(std::string_view text, const std::string& file) {
  const auto document = config::parse_toml(text, file);
  if (!document) return tl::unexpected(document.error());
  constexpr std::array<std::string_view, 3> kLists = {"columns", "readings", "factors"};
  for (const config::TomlEntry& entry : document->entries) {
    const auto list = suites::list_of_key(entry.key);
    if (!list || std::ranges::find(kLists, *list) == kLists.end())
      return suites::unknown_key(entry.place, entry.key, kLists, "a file of readings");
  }
  Table1Protocol protocol;
  for (const suites::EntryTable& table : suites::entry_tables(*document, "columns")) {
    Column& c = protocol.columns.emplace_back();
    if (auto read =
            read_table(table, "a column", {{{"group", &c.group}, {"row", &c.row}, {"is", &c.is}}, {}});
        !read)
      return tl::unexpected(read.error());
  }
  for (const suites::EntryTable& table : suites::entry_tables(*document, "readings")) {
    Reading& r = protocol.readings.emplace_back();
    const Targets targets{{{"name", &r.name},
                           {"sentence", &r.sentence},
                           {"for", &r.speaks_for},
                           {"against", &r.speaks_against},
                           {"dm", &r.dm},
                           {"ours", &r.ours}},
                          {{"set", &r.set}, {"set_dm", &r.set_dm}}};
    if (auto read = read_table(table, "a reading", targets); !read) return tl::unexpected(read.error());
  }
  std::vector<FactorLevel> levels;
  for (const suites::EntryTable& table : suites::entry_tables(*document, "factors")) {
    FactorLevel& l = levels.emplace_back();
    if (auto read =
            read_table(table, "a factor", {{{"factor", &l.factor}, {"level", &l.level}}, {{"set", &l.set}}});
        !read)
      return tl::unexpected(read.error());
  }
  for (Reading& reading : factorial(levels)) protocol.readings.push_back(std::move(reading));
  if (auto whole = check_whole(protocol, file); !whole) return tl::unexpected(whole.error());
  return protocol;
}

Result<Table1Protocol> table1_protocol() {
  const auto text = text_of(kReadings);
  if (!text) return tl::unexpected(text.error());
  return parse_table1_protocol(*text, std::string(kReadings));
}

Result<suites::Suite> table1_suite() { return embedded_suite(kRecordings); }

Result<suites::Suite> figures_suite() { return embedded_suite(kFigures); }

}  // namespace fusebench::reproduction
