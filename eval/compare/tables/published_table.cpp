#include "eval/compare/tables/published_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "core/config/toml_document.hpp"

namespace fusebench::tables {

namespace {

Result<void> read_text(const config::TomlEntry& entry, std::string& text) {
  const auto* value = config::plain_value<std::string>(entry);
  if (value == nullptr) return config::wrong_value(entry, "a text");
  text = *value;
  return {};
}

Result<void> read_flag(const config::TomlEntry& entry, bool& flag) {
  const auto* value = config::plain_value<bool>(entry);
  if (value == nullptr) return config::wrong_value(entry, "true or false");
  flag = *value;
  return {};
}

Result<void> read_texts(const config::TomlEntry& entry, std::vector<std::string>& texts) {
  const auto* list = std::get_if<config::TomlList>(&entry.value);
  if (list == nullptr || list->empty()) return config::wrong_value(entry, "a list of texts");
  texts.clear();
  for (const config::OptionValue& value : *list) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr) return config::wrong_value(entry, "a list of texts");
    texts.push_back(*text);
  }
  return {};
}

/// Numbers; an empty text stands for one that is not given.
Result<void> read_numbers(const config::TomlEntry& entry, std::vector<std::optional<double>>& numbers) {
  const auto* list = std::get_if<config::TomlList>(&entry.value);
  if (list == nullptr) return config::wrong_value(entry, "a list of numbers");
  for (const config::OptionValue& value : *list) {
    if (const auto* number = std::get_if<double>(&value)) {
      numbers.emplace_back(*number);
    } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
      numbers.emplace_back(static_cast<double>(*whole));
    } else if (const auto* text = std::get_if<std::string>(&value); text != nullptr && text->empty()) {
      numbers.emplace_back(std::nullopt);
    } else {
      return config::wrong_value(entry, "a list of numbers, or \"\" where there is none");
    }
  }
  return {};
}

Result<void> read_value(const config::TomlEntry& entry, const registry::RunMetric*& value) {
  std::string name;
  if (auto read = read_text(entry, name); !read) return read;
  value = registry::find_metric(name);
  if (value == nullptr || value->takes_several_runs())
    return config::wrong_value(entry, fmt::format("a value of runs, such as ate_rmse_m (is '{}')", name));
  return {};
}

Result<void> read_row_entry(const config::TomlEntry& entry, std::string_view key, PublishedRow& row) {
  if (key == "group") return read_text(entry, row.group);
  if (key == "label") return read_text(entry, row.label);
  if (key == "recording") return read_text(entry, row.recording);
  if (key == "published") return read_numbers(entry, row.published);
  return fail(ErrorCode::configuration, fmt::format("{}: unknown key {}", entry.place, entry.key));
}

Result<void> read_entry(const config::TomlEntry& entry, PublishedTable& table) {
  if (entry.key == "name") return read_text(entry, table.name);
  if (entry.key == "title") return read_text(entry, table.title);
  if (entry.key == "source") return read_text(entry, table.source);
  if (entry.key == "verified") return read_flag(entry, table.verified);
  if (entry.key == "note") return read_text(entry, table.note);
  if (entry.key == "value") return read_value(entry, table.value);
  if (entry.key == "systems") return read_texts(entry, table.systems);
  if (entry.key == "variants") return read_texts(entry, table.variants);
  if (entry.key == "ratio") return read_flag(entry, table.ratio);
  constexpr std::string_view kRows = "rows[";
  const std::size_t dot = entry.key.find("].");
  if (!entry.key.starts_with(kRows) || dot == std::string::npos)
    return fail(ErrorCode::configuration, fmt::format("{}: unknown key {}", entry.place, entry.key));
  const auto row = static_cast<std::size_t>(std::stoul(entry.key.substr(kRows.size())));
  if (table.rows.size() <= row) table.rows.resize(row + 1);
  return read_row_entry(entry, std::string_view(entry.key).substr(dot + 2), table.rows[row]);
}

Result<void> check_whole(const PublishedTable& table, const std::string& file) {
  if (table.name.empty() || table.title.empty() || table.source.empty() || table.value == nullptr ||
      table.systems.empty() || table.rows.empty()) {
    return fail(ErrorCode::configuration,
                fmt::format("{}: needs name, title, source, value, systems and rows", file));
  }
  for (const PublishedRow& row : table.rows) {
    if (row.published.size() != table.systems.size() || row.label.empty()) {
      return fail(ErrorCode::configuration,
                  fmt::format("{}: row '{}' has {} published numbers for {} systems", file, row.label,
                              row.published.size(), table.systems.size()));
    }
  }
  return {};
}

}  // namespace

Result<PublishedTable> parse_published_table(std::string_view text, const std::string& file) {
  const auto document = config::parse_toml(text, file);
  if (!document) return tl::unexpected(document.error());
  PublishedTable table;
  for (const config::TomlEntry& entry : document->entries) {
    if (auto read = read_entry(entry, table); !read) return tl::unexpected(read.error());
  }
  if (auto whole = check_whole(table, file); !whole) return tl::unexpected(whole.error());
  return table;
}

Result<PublishedTable> published_table(std::string_view name) {
  std::string known;
  for (const PublishedFile& file : published_files()) {
    auto table = parse_published_table(file.text, file.file);
    if (!table || table->name == name) return table;
    known += (known.empty() ? "" : ", ") + table->name;
  }
  return fail(ErrorCode::usage, fmt::format("unknown table '{}'", name), "there are " + known);
}

}  // namespace fusebench::tables
