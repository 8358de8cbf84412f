#include "eval/compare/aggregate/record_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "eval/record/run_files/record_files.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::aggregate {

namespace {

using Scalar = std::variant<std::nullptr_t, bool, std::int64_t, double, std::string_view>;

/// Member: of RunRow, or of RunIdentity.
template <auto Member>
bool text(RunRow& row, const Scalar& value) {
  const auto* given = std::get_if<std::string_view>(&value);
  if (given != nullptr) row.*Member = *given;
  return given != nullptr;
}

template <auto Member>
bool count(RunRow& row, const Scalar& value) {
  const auto* given = std::get_if<std::int64_t>(&value);
  if (given == nullptr || *given < 0) return false;
  row.*Member = static_cast<std::size_t>(*given);
  return true;
}

/// The number of a scalar; nothing of null. False if it is none.
bool read_number(const Scalar& value, std::optional<double>& number) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    number = static_cast<double>(*whole);
  } else if (const auto* given = std::get_if<double>(&value)) {
    number = *given;
  } else {
    return std::holds_alternative<std::nullptr_t>(value);
  }
  return true;
}

bool schema(RunRow&, const Scalar& value) {
  const auto* given = std::get_if<std::int64_t>(&value);
  return given != nullptr && *given == record::kRecordSchema;
}

bool status(RunRow& row, const Scalar& value) {
  const auto* given = std::get_if<std::string_view>(&value);
  const auto parsed = given == nullptr ? std::nullopt : record::parse_run_status(*given);
  if (parsed) row.status = *parsed;
  return parsed.has_value();
}

/// What is kept of a value of the record: a part of the row's identity, a number of the registry, or both.
struct Field {
  std::string_view path;
  bool (*set)(RunRow& row, const Scalar& value) = nullptr;
  bool required = false;
  const registry::RunMetric* metric = nullptr;
};

constexpr auto kIdentityFields = std::to_array<Field>({
    {"schema", schema, true},
    {"status", status, true},
    {"reason", text<&RunRow::reason>, true},
    {"recording.name", text<&RunRow::recording>, true},
    {"recording.data", text<&RunRow::data>},
    {"recording.imu", text<&RunRow::imu>},
    {"recording.truth", text<&RunRow::truth>},
    {"recording.first_frame", count<&RunRow::first_frame>},
    {"recording.frames", count<&RunRow::frames>},
    {"recording.whole_frames", count<&RunRow::whole_frames>},
    {"recording.fingerprint", text<&RunRow::fingerprint>},
    {"variant", text<&RunRow::variant>, true},
    {"config_hash", text<&RunRow::config_hash>, true},
    {"repetition", count<&RunRow::repetition>},
    {"replicate", count<&RunRow::replicate>},
    {"frames.total", count<&RunRow::total>, true},
    {"frames.tracked", count<&RunRow::tracked>, true},
    {"frames.lost", count<&RunRow::lost>, true},
});

/// All fields by path, so that those with the same beginning stand together. Every record has costs.
std::vector<Field> all_fields() {
  std::vector<Field> fields(kIdentityFields.begin(), kIdentityFields.end());
  for (const registry::RunMetric& metric : registry::run_metrics()) {
    if (metric.path.empty()) continue;
    const auto same = std::ranges::find(fields, metric.path, &Field::path);
    if (same != fields.end()) {
      same->metric = &metric;
    } else {
      fields.push_back({metric.path, nullptr, metric.kind == registry::MetricKind::cost, &metric});
    }
  }
  std::ranges::sort(fields, {}, &Field::path);
  return fields;
}

const std::vector<Field>& fields() {
  static const std::vector<Field> kFields = all_fields();
  return kFields;
}

constexpr std::string_view kConfig = "config";
constexpr std::string_view kFiles = "files";
constexpr std::string_view kProgram = "program";

/// Follows the events of the parser; whatever no field begins with is passed over.
class RecordHandler {
 public:
  RecordHandler(std::string_view json, RunRow& row, std::vector<record::RecordedFile>* files)
      : json_(json), row_(row), files_(files) {}

  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] bool has_config() const { return has_config_; }
  [[nodiscard]] bool has_program() const { return has_program_; }
  /// The path of a field that must be there and was not; empty if there is none.
  [[nodiscard]] std::string_view missing() const {
    for (std::size_t i = 0; i < fields().size(); ++i) {
      if (fields()[i].required && !seen_[i]) return fields()[i].path;
    }
    return has_config_seen_ ? std::string_view() : kConfig;
  }

  bool null() { return scalar(nullptr); }
  bool boolean(bool value) { return scalar(value); }
  bool number_integer(std::int64_t value) { return scalar(value); }
  bool number_unsigned(std::uint64_t value) {
    if (std::in_range<std::int64_t>(value)) return scalar(static_cast<std::int64_t>(value));
    return scalar(static_cast<double>(value));
  }
  bool number_float(double value, const std::string&) { return scalar(value); }
  bool string(const std::string& value) { return scalar(std::string_view(value)); }
  bool binary(const std::vector<std::uint8_t>&) { return false; }  // JSON text has none

  bool start_object(std::size_t) {
    count_element();
    levels_.push_back(levels_.empty() ? Level{0, fields().size(), 0, Kind::fields} : next_);
    if (levels_.back().kind == Kind::option) option_.clear();
    return true;
  }
  bool end_object() {
    const Kind kind = levels_.back().kind;
    levels_.pop_back();
    return kind != Kind::option || finish_option();
  }
  bool start_array(std::size_t) {
    count_element();
    levels_.push_back(next_.kind == Kind::fields ? next_ : Level{});
    levels_.back().is_array = true;
    return true;
  }
  bool end_array() {
    levels_.pop_back();
    return true;
  }

  bool key(const std::string& key) {
    const Level& level = levels_.back();
    switch (level.kind) {
      case Kind::fields:
        next_ = narrowed(level, key);
        if (key == kFiles && (levels_.size() == 1 || is_timing(level))) next_ = {0, 0, 0, Kind::files};
        has_program_ = has_program_ || (levels_.size() == 1 && key == kProgram);
        if (levels_.size() == 1 && key == kConfig) {
          next_ = {0, 0, 0, Kind::config};
          has_config_seen_ = true;
        }
        break;
      case Kind::config:
        option_key_ = key;
        next_ = {0, 0, 0, Kind::option};
        break;
      case Kind::option:
        member_ = key;
        next_ = {0, 0, 0, Kind::option_member};
        break;
      case Kind::option_member:
        next_ = {};
        break;
      case Kind::files:
        if (files_ != nullptr) files_->push_back({key, 0, {}});
        next_ = {0, 0, 0, Kind::file};
        break;
      case Kind::file:
        next_ = {0, 0, 0, key == "bytes" ? Kind::file_bytes : Kind::file_member};
        break;
      case Kind::file_bytes:
      case Kind::file_member:
        break;
    }
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception&) {
    problem_ = record::no_json(json_, byte);
    return false;
  }

 private:
  enum class Kind { fields, config, option, option_member, files, file, file_bytes, file_member };
  /// Where in the document we are: the fields [first, last) share this beginning of `prefix` characters.
  struct Level {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t prefix = 0;
    Kind kind = Kind::fields;
    bool is_array = false;
    std::size_t elements = 0;  ///< of the array so far
  };
  struct Option {
    std::string value;
    std::string origin;
    void clear() {
      value.clear();
      origin.clear();
    }
  };

  static bool is_timing(const Level& level) {
    return level.first < level.last && fields()[level.first].path.substr(0, level.prefix) == "timing.";
  }

  /// The place of a value in an array is the key of its fields.
  void count_element() {
    if (levels_.empty() || !levels_.back().is_array) return;
    next_ = narrowed(levels_.back(), fmt::format("{}", levels_.back().elements++));
  }

  static Level narrowed(const Level& level, std::string_view key) {
    Level next{level.first, level.first, level.prefix + key.size(), Kind::fields};
    const auto begins = [&](std::size_t i) {
      const std::string_view rest = fields()[i].path.substr(std::min(level.prefix, fields()[i].path.size()));
      return rest.starts_with(key) && (rest.size() == key.size() || rest[key.size()] == '.');
    };
    while (next.first < level.last && !begins(next.first)) ++next.first;
    next.last = next.first;
    while (next.last < level.last && begins(next.last)) ++next.last;
    if (next.first < next.last && fields()[next.first].path.size() > next.prefix) ++next.prefix;  // the point
    return next;
  }

  bool scalar(const Scalar& value) {
    if (levels_.empty()) return true;  // the document is one value: fields will be missing
    count_element();
    if (next_.kind == Kind::option_member) return option_member(value);
    if (next_.kind == Kind::file_member) return true;
    if (next_.kind == Kind::file_bytes) return file_bytes(value);
    if (next_.kind == Kind::files || next_.kind == Kind::file) return wrong(kFiles);
    if (next_.kind != Kind::fields) return wrong(kConfig);
    if (next_.first == next_.last || levels_.back().first == levels_.back().last) return true;
    const Field& field = fields()[next_.first];
    if (field.path.size() != next_.prefix) return true;  // null in place of a block: it holds no numbers
    seen_[next_.first] = true;
    if (field.set != nullptr && !field.set(row_, value)) return wrong(field.path);
    return field.metric == nullptr || keep_number(*field.metric, value) || wrong(field.path);
  }

  /// A cost of zero is that of a run that was not timed.
  bool keep_number(const registry::RunMetric& metric, const Scalar& value) {
    std::optional<double> number;
    if (!read_number(value, number)) return false;
    if (metric.kind == registry::MetricKind::cost && number && *number <= 0) number.reset();
    row_.numbers.set(metric, number);
    return true;
  }

  bool option_member(const Scalar& value) {
    if (levels_.back().kind != Kind::option) return true;
    const auto* given = std::get_if<std::string_view>(&value);
    if (member_ == "origin") {
      if (given == nullptr) return wrong(option_key_);
      option_.origin = *given;
    } else if (member_ == "value") {
      if (std::holds_alternative<std::nullptr_t>(value)) return wrong(option_key_);
      option_.value = text_of(value);
    }
    return true;
  }

  bool file_bytes(const Scalar& value) {
    const auto* given = std::get_if<std::int64_t>(&value);
    if (given == nullptr || *given < 0) return wrong(kFiles);
    if (files_ != nullptr) files_->back().bytes = static_cast<std::uint64_t>(*given);
    return true;
  }

  static std::string text_of(const Scalar& value) {
    if (const auto* given = std::get_if<bool>(&value)) return *given ? "true" : "false";
    if (const auto* given = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *given);
    if (const auto* given = std::get_if<double>(&value)) return fmt::format("{}", *given);
    const auto* given = std::get_if<std::string_view>(&value);
    return given == nullptr ? std::string() : std::string(*given);
  }

  bool finish_option() {
    if (option_.origin.empty()) return wrong(option_key_);
    has_config_ = true;
    if (run_files::is_edit(option_.origin)) row_.options.emplace_back(option_key_, option_.value);
    return true;
  }

  bool wrong(std::string_view path) {
    problem_ = fmt::format("{} has a value that this program does not read", path);
    return false;
  }

  std::string_view json_;
  RunRow& row_;
  std::vector<record::RecordedFile>* files_;
  std::vector<Level> levels_;
  Level next_;
  std::string option_key_;
  std::string member_;
  Option option_;
  bool has_config_ = false;
  bool has_config_seen_ = false;
  bool has_program_ = false;  // from outside
  std::vector<bool> seen_ = std::vector<bool>(fields().size());
  std::string problem_;
};

/// A record of another version of this program is not damaged.
std::string reason_of(const std::string& problem) {
  return problem.starts_with("schema ") ? "record.json: " + problem
                                        : run_files::damage_text("record.json", problem);
}

}  // namespace

RunRow damaged_row(RunRow row, std::string reason) {
  row.numbers = {};
  row.status = record::RunStatus::failed;
  row.readable = false;
  row.reason = std::move(reason);
  row.options.clear();
  row.wrote_options = false;
  row.fingerprint = row.imu = "";
  row.total = row.tracked = row.lost = row.first_frame = row.frames = row.whole_frames = 0;
  row.repetition = 1;
  row.replicate = 0;
  return row;
}

RunRow row_without_record(RunRow row, std::string reason) {
  row.data = row.truth = record::kUnknownWord;
  return damaged_row(std::move(row), std::move(reason));
}

RunRow scan_record(std::string_view json, std::vector<record::RecordedFile>* files) {
  RunRow row;
  RecordHandler handler(json, row, files);
  if (!nlohmann::json::sax_parse(json.begin(), json.end(), &handler))
    return row_without_record(std::move(row), reason_of(handler.problem()));
  if (const auto missing = handler.missing(); !missing.empty())
    return row_without_record(std::move(row), reason_of(fmt::format("{} is missing", missing)));
  std::ranges::sort(row.options);
  row.wrote_options = handler.has_config() && !handler.has_program();
  if (row.fingerprint.empty()) row.imu.clear();  // what stands there is the default
  // A run that was never started says nothing of its options; one of another program has none.
  row.options_known = handler.has_config() || row.status != record::RunStatus::failed;
  row.numbers.set(registry::run_metric("runs_not_ok"), row.status == record::RunStatus::ok ? 0 : 1);
  row.numbers.derive();
  return row;
}

}  // namespace fusebench::aggregate
