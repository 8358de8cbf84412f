#include "core/config/toml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <tuple>

// The library as it is built by Debian reads numbers through a stream, which takes memory that has run out
// for a number that is none. Compiled here, from_chars reads them.
#define TOML_HEADER_ONLY 1
#define TOML_FLOAT_CHARCONV 1
#include <toml++/toml.h>

#include "core/base/io/input_file.hpp"
#include "core/base/printable.hpp"

namespace fusebench::config {

namespace {

struct Located {
  toml::source_position position;
  TomlEntry entry;
};

std::optional<OptionValue> plain_value(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return OptionValue{flag->get()};
  if (const auto* integer = node.as_integer()) return OptionValue{integer->get()};
  if (const auto* number = node.as_floating_point()) return OptionValue{number->get()};
  if (const auto* text = node.as_string()) return OptionValue{text->get()};
  return std::nullopt;
}

// Files that people write stay far below these. The parser follows every level of a key by a call of its own,
// so that a longer key could exhaust the stack.
constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::ptrdiff_t kMostDotsInLine = 500;
constexpr std::size_t kLongestKey = 200;

std::optional<Error> refuse_size(std::string_view text, const std::string& name) {
  const auto refused = [](std::string message) {
    return Error{ErrorCode::configuration, std::move(message), "is it the right file?"};
  };
  if (text.size() > kLargestFile) {
    return refused(fmt::format("{}: more than {} bytes are too many for a TOML file", name, kLargestFile));
  }
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t length = std::min(text.find('\n'), text.size() - 1) + 1;
    if (std::ranges::count(text.substr(0, length), '.') > kMostDotsInLine)
      return refused(fmt::format("{}:{}: more than {} dots in a line", name, line, kMostDotsInLine));
    text.remove_prefix(length);
  }
  return std::nullopt;
}

/// Keys here are bare ones; quoted ones may hold anything, also dots.
bool is_bare(std::string_view key) {
  return !key.empty() && std::ranges::all_of(key, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
  });
}

/// Collects the leaves of a table; the parser keeps them sorted by key, the caller sorts them by position.
class Collector {
 public:
  explicit Collector(const std::string& name) : name_(name) {}

  Result<void> visit(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
      const std::string key =
          prefix.empty() ? std::string(name.str()) : fmt::format("{}.{}", prefix, name.str());
      if (!is_bare(name.str()) || key.size() > kLongestKey) {
        return fail(ErrorCode::configuration,
                    fmt::format("{}: the key '{}' is no name of letters, digits, _ and -, up to {} in all",
                                place(node), printable(key), kLongestKey));
      }
      if (const auto* nested = node.as_table()) {
        if (auto visited = visit_nested(*nested, key); !visited) return visited;
      } else if (const auto* list = node.as_array(); list != nullptr && list->is_array_of_tables()) {
        for (std::size_t i = 0; i < list->size(); ++i) {
          const auto visited = visit_nested(*list->get_as<toml::table>(i), fmt::format("{}[{}]", key, i));
          if (!visited) return visited;
        }
      } else if (auto added = add(key, node); !added) {
        return added;
      }
    }
    return {};
  }

  TomlDocument finish() {
    const auto earlier = [](const toml::source_position& a, const toml::source_position& b) {
      return std::tie(a.line, a.column) < std::tie(b.line, b.column);
    };
    std::stable_sort(leaves_.begin(), leaves_.end(),
                     [&](const Located& a, const Located& b) { return earlier(a.position, b.position); });
    std::stable_sort(tables_.begin(), tables_.end(),
                     [&](const auto& a, const auto& b) { return earlier(a.first, b.first); });
    TomlDocument document;
    for (Located& leaf : leaves_) document.entries.push_back(std::move(leaf.entry));
    for (auto& table : tables_) document.tables.push_back(std::move(table.second));
    return document;
  }

 private:
  std::string place(const toml::node& node) const {
    return fmt::format("{}:{}", name_, node.source().begin.line);
  }

  Result<void> visit_nested(const toml::table& table, const std::string& key) {
    tables_.emplace_back(table.source().begin, TomlTable{key, place(table)});
    return visit(table, key);
  }

  Result<void> add(const std::string& key, const toml::node& node) {
    Located leaf{node.source().begin, {key, OptionValue{false}, place(node)}};
    if (const auto value = plain_value(node)) {
      leaf.entry.value = *value;
    } else if (const auto* array = node.as_array()) {
      TomlList list;
      for (const toml::node& element : *array) {
        const auto item = plain_value(element);
        if (!item) return unsupported(key, element);
        list.push_back(*item);
      }
      leaf.entry.value = std::move(list);
    } else {
      return unsupported(key, node);
    }
    leaves_.push_back(std::move(leaf));
    return {};
  }

  Result<void> unsupported(const std::string& key, const toml::node& node) const {
    return fail(ErrorCode::configuration,
                fmt::format("{}: {} must be a flag, a number, a text or a list of these", place(node), key));
  }

  const std::string& name_;
  std::vector<Located> leaves_;
  std::vector<std::pair<toml::source_position, TomlTable>> tables_;
};

}  // namespace

Result<TomlDocument> parse_toml(std::string_view text, const std::string& name) {
  if (auto refused = refuse_size(text, name)) return tl::unexpected(std::move(*refused));
  try {
    const toml::table root = toml::parse(text, name);
    Collector collector(name);
    if (auto visited = collector.visit(root, ""); !visited) return tl::unexpected(visited.error());
    return collector.finish();
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::configuration,
                fmt::format("{}:{}: not valid TOML: {}", name, error.source().begin.line,
                            printable(error.description(), 300)));
  }
}

Result<TomlDocument> read_toml(const std::filesystem::path& file) {
  std::ifstream stream = io::input_file(file);
  if (!stream || std::filesystem::is_directory(file)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  }
  std::string text;
  std::array<char, 1 << 14> part{};
  while (text.size() <= kLargestFile && stream) {  // parse_toml() refuses what is larger
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) return fail(ErrorCode::data_corrupt, fmt::format("{}: read error", file.string()));
  return parse_toml(text, file.string());
}

std::string to_toml(const OptionValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* number = std::get_if<double>(&value)) {
    std::string text = fmt::format("{}", *number);
    // "1" would read back as an integer.
    if (std::isfinite(*number) && text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
  }
  std::string quoted = "\"";
  for (const char c : std::get<std::string>(value)) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c >= 0 && (c < ' ' || c == '\x7F')) {
      quoted += fmt::format("\\u{:04X}", static_cast<int>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace fusebench::config
