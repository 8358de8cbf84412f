#include "core/config/config_access.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>

#include "core/base/io/fingerprint.hpp"
#include "core/base/nearest_name.hpp"
#include "core/base/printable.hpp"
#include "core/config/config.hpp"
#include "core/config/toml_document.hpp"

namespace fusebench::config {

namespace {

/// Runs `inner` with the dotted prefix of the group it is in.
template <class Derived>
struct GroupWalker {
  std::string prefix;

  [[nodiscard]] std::string full_key(std::string_view key) const { return prefix + std::string(key); }

  template <class Nested>
  void group(std::string_view key, Nested& nested) {
    const std::string outer = prefix;
    prefix += fmt::format("{}.", key);
    std::remove_const_t<Nested>::visit(nested, static_cast<Derived&>(*this));
    prefix = outer;
  }
};

template <class Number>
std::string number_text(Number value) {
  if constexpr (std::integral<Number>) {
    return to_toml(OptionValue{static_cast<std::int64_t>(value)});
  } else {
    return to_toml(OptionValue{static_cast<double>(value)});
  }
}

template <class Enum>
std::string choice_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, value] : option_choices(Enum{})) names.push_back(name);
  return fmt::format("{}", fmt::join(names, " | "));
}

template <class Enum>
std::string choice_text(const Enum& value) {
  std::string_view current;
  for (const auto& [name, candidate] : option_choices(Enum{})) {
    if (candidate == value) current = name;
  }
  return to_toml(OptionValue{std::string(current)});
}

struct DescribeVisitor : GroupWalker<DescribeVisitor> {
  std::vector<OptionRow> rows;

  template <class Number>
  void number(std::string_view key, const Number& value, std::type_identity_t<Number> low,
              std::type_identity_t<Number> high, std::string_view sentence) {
    rows.push_back({full_key(key), std::integral<Number> ? "integer" : "number", number_text(value),
                    fmt::format("{} .. {}", low, high), std::string(sentence)});
  }
  void flag(std::string_view key, const bool& value, std::string_view sentence) {
    rows.push_back({full_key(key), "flag", value ? "true" : "false", "true | false", std::string(sentence)});
  }
  template <class Enum>
  void choice(std::string_view key, const Enum& value, std::string_view sentence) {
    rows.push_back(
        {full_key(key), "choice", choice_text(value), choice_names<Enum>(), std::string(sentence)});
  }
};

/// Keys and values as DescribeVisitor has them, without the rest: every run of a plan needs its hash.
struct HashVisitor : GroupWalker<HashVisitor> {
  io::Fingerprint fingerprint;

  template <class Number>
  void number(std::string_view key, const Number& value, std::type_identity_t<Number>,
              std::type_identity_t<Number>, std::string_view) {
    add(key, number_text(value));
  }
  void flag(std::string_view key, const bool& value, std::string_view) { add(key, value ? "true" : "false"); }
  template <class Enum>
  void choice(std::string_view key, const Enum& value, std::string_view) {
    add(key, choice_text(value));
  }

 private:
  void add(std::string_view key, std::string_view value) {
    fingerprint.add(fmt::format("{}{}={}\n", prefix, key, value));
  }
};

/// Assigns one value to the option of that key; remembers what happened.
struct SetVisitor : GroupWalker<SetVisitor> {
  SetVisitor(std::string_view wanted_key, const OptionValue& wanted_value)
      : wanted(wanted_key), value(wanted_value) {}

  std::string_view wanted;
  const OptionValue& value;
  bool found = false;
  std::optional<Error> error;

  template <class Number>
  void number(std::string_view key, Number& target, std::type_identity_t<Number> low,
              std::type_identity_t<Number> high, std::string_view) {
    if (!matches(key)) return;
    const std::string range = fmt::format("{} .. {}", low, high);
    const std::optional<double> given = numeric<Number>();
    if (!given)
      return reject(fmt::format("{}, {}", std::integral<Number> ? "an integer" : "a number", range));
    // Written so that NaN fails.
    if (!(*given >= static_cast<double>(low) && *given <= static_cast<double>(high))) return reject(range);
    target = static_cast<Number>(*given);
  }
  void flag(std::string_view key, bool& target, std::string_view) {
    if (!matches(key)) return;
    if (const auto* given = std::get_if<bool>(&value)) {
      target = *given;
    } else {
      reject("true | false");
    }
  }
  template <class Enum>
  void choice(std::string_view key, Enum& target, std::string_view) {
    if (!matches(key)) return;
    if (const auto* given = std::get_if<std::string>(&value)) {
      for (const auto& [name, candidate] : option_choices(Enum{})) {
        if (name == *given) {
          target = candidate;
          return;
        }
      }
    }
    reject(choice_names<Enum>());
  }

 private:
  bool matches(std::string_view key) {
    if (found || full_key(key) != wanted) return false;
    found = true;
    return true;
  }
  // Integers reach 2^31 here, far below what a double holds exactly, so one comparison serves both.
  template <class Number>
  std::optional<double> numeric() const {
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
    if (const auto* number = std::get_if<double>(&value); number != nullptr && std::floating_point<Number>) {
      return *number;
    }
    return std::nullopt;
  }
  void reject(const std::string& allowed) {
    error = Error{ErrorCode::configuration,
                  fmt::format("{} = {} (allowed: {})", wanted, printable(to_toml(value), 100), allowed),
                  "`fusebench config` lists each option with its range"};
  }
};

/// A table header that no option lives under is a typing error, also when the table is empty.
Result<void> check_group(const Config& config, const TomlTable& table) {
  const std::vector<OptionRow> rows = describe_options(config);
  std::vector<std::string_view> groups;
  for (const OptionRow& row : rows) {
    const std::string_view group = std::string_view(row.key).substr(0, row.key.rfind('.'));
    if (group == table.key) return {};
    if (groups.empty() || groups.back() != group) groups.push_back(group);
  }
  return fail(
      ErrorCode::configuration,
      fmt::format("{}: unknown table [{}]{}", table.place, table.key, nearest_hint(table.key, groups)),
      fmt::format("tables are {}", fmt::join(groups, ", ")));
}

Error with_origin(Error error, const std::string& origin) {
  error.message = fmt::format("{}: {}", origin, error.message);
  return error;
}

}  // namespace

std::vector<OptionRow> describe_options(const Config& config) {
  DescribeVisitor visitor;
  Config::visit(config, visitor);
  return std::move(visitor.rows);
}

Result<void> set_option(Config& config, std::string_view key, const OptionValue& value) {
  SetVisitor visitor(key, value);
  Config::visit(config, visitor);
  if (visitor.error) return tl::unexpected(*visitor.error);
  if (visitor.found) return {};
  const std::vector<OptionRow> rows = describe_options(config);
  std::vector<std::string_view> names;
  for (const OptionRow& row : rows) names.push_back(row.key);
  return fail(ErrorCode::configuration, fmt::format("unknown option '{}'{}", key, nearest_hint(key, names)),
              "`fusebench config` lists all options");
}

Result<void> check_relations(const Config& config) {
  const auto violated = [](std::string message) {
    return fail(ErrorCode::configuration, std::move(message));
  };
  if (!(config.depth.min_m < config.depth.max_m)) {
    return violated(fmt::format("depth.min_m = {} (allowed: less than depth.max_m = {})", config.depth.min_m,
                                config.depth.max_m));
  }
  if (!(config.tsdf.truncation_m >= 2 * config.tsdf.voxel_m)) {
    return violated(
        fmt::format("tsdf.truncation_m = {} (allowed: at least two voxels, 2 * tsdf.voxel_m = {})",
                    config.tsdf.truncation_m, 2 * config.tsdf.voxel_m));
  }
  return {};
}

EffectiveConfig::EffectiveConfig() : values_(std::make_unique<Config>()) {}
EffectiveConfig::EffectiveConfig(const EffectiveConfig& other)
    : origins(other.origins), values_(std::make_unique<Config>(*other.values_)) {}
EffectiveConfig::EffectiveConfig(EffectiveConfig&& other) noexcept = default;
EffectiveConfig& EffectiveConfig::operator=(const EffectiveConfig& other) {
  if (this != &other) *this = EffectiveConfig(other);
  return *this;
}
EffectiveConfig& EffectiveConfig::operator=(EffectiveConfig&& other) noexcept = default;
EffectiveConfig::~EffectiveConfig() = default;

Result<void> EffectiveConfig::set(std::string_view key, const OptionValue& value, const std::string& origin) {
  if (auto done = set_option(*values_, key, value); !done)
    return tl::unexpected(with_origin(done.error(), origin));
  origins[std::string(key)] = origin;
  return {};
}

Result<void> EffectiveConfig::set_assignment(std::string_view assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    return fail(ErrorCode::configuration, fmt::format("--set {}: expected key=value", assignment),
                "for example --set iekf.max_iterations=8");
  }
  return set(assignment.substr(0, equals), parse_option_value(assignment.substr(equals + 1)), "--set");
}

OptionValue parse_option_value(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  // from_chars takes no leading '+', people do.
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const char* const end = digits.data() + digits.size();
  std::int64_t integer = 0;
  if (const auto read = std::from_chars(digits.data(), end, integer);
      read.ec == std::errc{} && read.ptr == end) {
    return integer;
  }
  double number = 0;
  if (const auto read = std::from_chars(digits.data(), end, number);
      read.ec == std::errc{} && read.ptr == end) {
    return number;
  }
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

Result<void> apply_config_file(EffectiveConfig& config, const std::filesystem::path& file) {
  const auto document = read_toml(file);
  if (!document) return tl::unexpected(document.error());
  for (const TomlTable& table : document->tables) {
    if (auto known = check_group(config.values(), table); !known) return known;
  }
  for (const TomlEntry& entry : document->entries) {
    const auto* value = std::get_if<OptionValue>(&entry.value);
    if (value == nullptr) {
      return fail(ErrorCode::configuration,
                  fmt::format("{}: {} takes one value, not a list", entry.place, entry.key));
    }
    // A file of all options, as `fusebench config` prints it, edits those alone that it changes.
    EffectiveConfig edited = config;
    if (auto done = edited.set(entry.key, *value, entry.place); !done) return done;
    if (config_hash(edited.values()) != config_hash(config.values())) config = std::move(edited);
  }
  return {};
}

std::string config_hash(const Config& config) {
  HashVisitor visitor;
  Config::visit(config, visitor);
  return visitor.fingerprint.hex().substr(0, 16);
}

}  // namespace fusebench::config
