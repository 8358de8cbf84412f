#include "datasets/recording/reading/sensor_yaml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/printable.hpp"
#include "datasets/calibration/distortion_model.hpp"

namespace fusebench::reading {

namespace {

constexpr std::size_t kMostBytes = 1 << 20;  // such files have a few kilobytes
constexpr std::size_t kMostNested = 16;
constexpr std::size_t kLongestKey = 100;

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) return line.substr(0, i);
  }
  return line;
}

std::string_view unquoted(std::string_view text) {
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
    return text.substr(1, text.size() - 2);
  return text;
}

int opening(char c) { return c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0; }

/// The text begins with a bracket and ends with the one that closes it.
bool is_bracketed(std::string_view text) {
  int open = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    open += opening(text[i]);
    if (open <= 0) return i > 0 && i + 1 == text.size();
  }
  return false;
}

/// Parts between commas that are in no bracket.
std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  int open = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size()) open += opening(text[i]);
    if (i < text.size() && (text[i] != ',' || open != 0)) continue;
    parts.push_back(trimmed(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  if (parts.back().empty()) parts.pop_back();  // a comma before the closing bracket, or nothing at all
  return parts;
}

/// "!!opencv-matrix" and the like say of what type a value is.
std::string_view without_tag(std::string_view value) {
  if (!value.starts_with("!!")) return value;
  return trimmed(value.substr(std::min(value.find(' '), value.size())));
}

/// A key above the current line, or an item of a sequence.
struct Level {
  std::size_t indent = 0;
  std::string key;
  bool is_item = false;
  std::size_t items = 0;  ///< of the sequence below it
};

/// What stands before and after the colon of "key: value"; nothing if there is no key.
struct KeyAndValue {
  std::string_view key;
  std::string_view value;
};
std::optional<KeyAndValue> key_and_value(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '[' || text[i] == '{' || text[i] == '"') return std::nullopt;
    if (text[i] != ':' || (i + 1 < text.size() && text[i + 1] != ' ' && text[i + 1] != '\t')) continue;
    const std::string_view key = trimmed(text.substr(0, i));
    if (key.empty() || key.size() > kLongestKey) return std::nullopt;
    return KeyAndValue{key, trimmed(text.substr(i + 1))};
  }
  return std::nullopt;
}

class Parser {
 public:
  Parser(std::string file, std::vector<YamlValue>& values) : file_(std::move(file)), values_(values) {}

  Result<void> line(std::string_view text) {
    ++number_;
    const std::string_view content = trimmed(without_comment(text));
    if (open_ > 0) return more_of_list(content);
    if (content.empty() || content.starts_with('%') || content.starts_with("---") || content == "...")
      return {};
    const std::size_t indent = text.find_first_not_of(' ');
    if (text[indent] == '\t') return wrong("a tab indents the line");
    if (content.starts_with("- ") || content == "-") return item(indent, trimmed(content.substr(1)));
    return pair(indent, content);
  }

  [[nodiscard]] Result<void> end() const {
    return open_ > 0 ? Result<void>(wrong("a list is not closed")) : Result<void>();
  }

 private:
  [[nodiscard]] tl::unexpected<Error> wrong(std::string_view what) const {
    return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: {}", file_, number_, what));
  }
  [[nodiscard]] tl::unexpected<Error> no_pair(std::string_view text) const {
    return wrong(fmt::format("expected 'key: value', got '{}'", printable(text, 100)));
  }

  Result<void> push(Level level) {
    if (levels_.size() >= kMostNested) return wrong("too deeply nested");
    levels_.push_back(std::move(level));
    return {};
  }

  /// "- ...", an item of the sequence below the last key that is not deeper.
  Result<void> item(std::size_t indent, std::string_view content) {
    while (!levels_.empty() &&
           (levels_.back().indent > indent || (levels_.back().indent == indent && levels_.back().is_item)))
      levels_.pop_back();
    if (levels_.empty() || levels_.back().is_item) return wrong("an item of a list without a key");
    const std::string name = std::to_string(levels_.back().items++);
    if (opening(content.empty() ? ' ' : content.front()) > 0) return value(name, content);
    if (const auto pushed = push({indent, name, true}); !pushed) return pushed;
    return content.empty() ? Result<void>{} : pair(indent + 1, content);
  }

  /// "key: value", or "key:" with what is deeper indented. It ends all that is as deep as itself.
  Result<void> pair(std::size_t indent, std::string_view content) {
    while (!levels_.empty() && levels_.back().indent >= indent) levels_.pop_back();
    const auto found = key_and_value(content);
    if (!found) return no_pair(content);
    const std::string key(unquoted(found->key));
    const std::string_view text = without_tag(found->value);
    return text.empty() ? push({indent, key}) : value(key, text);
  }

  Result<void> value(const std::string& key, std::string_view text) {
    std::string path;
    for (const Level& level : levels_) path += level.key + ".";
    path += key;
    if (opening(text.front()) <= 0) return add(path, {unquoted(text)});
    list_path_ = std::move(path);
    list_.clear();
    return more_of_list(text);
  }

  /// A list goes on until its bracket is closed.
  Result<void> more_of_list(std::string_view text) {
    for (const char c : text) open_ += opening(c);
    if (!list_.empty()) list_ += ' ';
    list_ += text;
    if (open_ > 0) return {};
    open_ = 0;
    return brackets(list_path_, list_, 0);
  }

  /// "[...]" or "{...}" of any depth.
  Result<void> brackets(const std::string& path, std::string_view text, std::size_t depth) {
    if (depth >= kMostNested) return wrong("too deeply nested");
    if (!is_bracketed(text)) return wrong("brackets do not match, or something follows the last one");
    const std::vector<std::string_view> parts = parts_of(text.substr(1, text.size() - 2));
    if (text.front() == '[') {
      std::vector<std::string_view> items;
      for (const std::string_view part : parts) items.push_back(unquoted(part));
      return add(path, items);
    }
    for (const std::string_view part : parts) {
      const auto found = key_and_value(part);
      if (!found) return no_pair(part);
      const std::string inner_path = fmt::format("{}.{}", path, unquoted(found->key));
      const std::string_view inner = without_tag(found->value);
      const bool nested = !inner.empty() && opening(inner.front()) > 0;
      if (auto added = nested ? brackets(inner_path, inner, depth + 1) : add(inner_path, {unquoted(inner)});
          !added)
        return added;
    }
    return {};
  }

  Result<void> add(const std::string& path, const std::vector<std::string_view>& items) {
    if (!keys_.insert(path).second)
      return wrong(fmt::format("the key {} stands there twice", printable(path, 100)));
    values_.push_back({path, {items.begin(), items.end()}, number_});
    return {};
  }

  std::string file_;
  std::vector<YamlValue>& values_;
  int number_ = 0;
  std::vector<Level> levels_;
  std::set<std::string> keys_;
  std::string list_;  ///< that is open, or was
  std::string list_path_;
  int open_ = 0;  ///< its brackets
};

}  // namespace

Result<SensorYaml> SensorYaml::read(const std::filesystem::path& file) {
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(file, error);
  std::ifstream stream = io::input_file(file);
  if (!is_file || !stream)
    return fail(
        ErrorCode::data_missing,
        fmt::format("{}: {}", file.string(),
                    std::filesystem::exists(file, error) ? "cannot be read as a file" : "no such file"));
  if (std::filesystem::file_size(file, error) > kMostBytes)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: larger than {} bytes, which no description of sensors is", file.string(),
                            kMostBytes));
  SensorYaml yaml;
  yaml.file_ = file.string();
  Parser parser(yaml.file_, yaml.values_);
  std::string line;
  while (std::getline(stream, line)) {
    if (const auto read = parser.line(line); !read) return tl::unexpected(read.error());
  }
  if (const auto ended = parser.end(); !ended) return tl::unexpected(ended.error());
  return yaml;
}

const YamlValue* SensorYaml::find(std::string_view key) const {
  const auto found = std::ranges::find(values_, key, &YamlValue::key);
  return found == values_.end() ? nullptr : &*found;
}

tl::unexpected<Error> SensorYaml::fail_at(std::string_view key, std::string_view what) const {
  const YamlValue* const value = find(key);
  const std::string place = value == nullptr ? file_ : fmt::format("{}:{}", file_, value->line);
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", place, what));
}

Result<std::string> SensorYaml::text(std::string_view key) const {
  const YamlValue* const value = find(key);
  if (value == nullptr) return fail_at(key, fmt::format("needs the key {}", key));
  if (value->items.size() != 1) return fail_at(key, fmt::format("{} must be one value, not a list", key));
  return value->items.front();
}

Result<double> SensorYaml::number(std::string_view key) const {
  return numbers(key, 1).map([](const std::vector<double>& values) { return values.front(); });
}

Result<std::vector<double>> SensorYaml::numbers(std::string_view key, std::size_t count) const {
  const YamlValue* const value = find(key);
  if (value == nullptr) return fail_at(key, fmt::format("needs the key {}", key));
  std::vector<double> numbers;
  for (const std::string& item : value->items) {
    if (const auto number = io::parse_number(item)) numbers.push_back(*number);
  }
  if (numbers.size() == count && value->items.size() == count) return numbers;
  return fail_at(key, count == 1 ? fmt::format("{} must be a finite number", key)
                                 : fmt::format("{} must be a list of {} finite numbers", key, count));
}

Result<calibration::BrownConrady> yaml_distortion(const SensorYaml& yaml, const std::string& model_key,
                                                  const std::string& coefficients_key) {
  const auto entry = std::ranges::find(yaml.values(), coefficients_key, &YamlValue::key);
  if (entry == yaml.values().end()) return calibration::BrownConrady{};
  const auto coefficients = yaml.numbers(coefficients_key, entry->items.size());
  if (!coefficients)
    return yaml.fail_at(
        coefficients_key,
        fmt::format("{} must be a list of finite numbers: k1, k2, p1, p2 and, if it is known, k3",
                    coefficients_key));
  auto distortion = calibration::distortion_of_model(yaml.text(model_key).value_or(""), *coefficients);
  if (distortion) return distortion;
  auto error = yaml.fail_at(yaml.has(model_key) ? model_key : coefficients_key, distortion.error().message);
  error.value().hint = distortion.error().hint;
  return error;
}

}  // namespace fusebench::reading
