#include "core/base/trajectory/pose_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/printable.hpp"

namespace fusebench::trajectory {

namespace {

using Words = std::vector<std::string>;

constexpr std::array<std::string_view, 7> kPositionWords = {"t",   "p",     "pos",        "position",
                                                            "loc", "trans", "translation"};
constexpr std::array<std::string_view, 7> kQuaternionWords = {"q",        "quat", "quaternion", "rot",
                                                              "rotation", "ori",  "orientation"};
/// Words that say of whom a value is, and not which one.
constexpr std::array<std::string_view, 38> kNeutralWords = {
    "field",       "pose",      "poses",     "transform", "msg",      "message", "data",   "gt",
    "groundtruth", "est",       "true",      "ref",       "estimate", "in",      "camera", "cam",
    "cam0",        "estimated", "reference", "body",      "base",     "imu",     "world",  "map",
    "odom",        "frame",     "image",     "img",       "rgb",      "color",   "sensor", "robot",
    "vehicle",     "kf",        "slam",      "vio",       "keyframe", "device"};
constexpr std::array<std::string_view, 9> kClockWords = {"header", "ros",   "unix", "epoch",  "system",
                                                         "time",   "posix", "utc",  "capture"};
/// A name with one of these is of another value than a pose.
constexpr std::array<std::string_view, 19> kOtherWords = {
    "v",   "vel", "velocity", "twist",      "linear", "angular",      "b",    "bias",  "std",  "sigma",
    "var", "cov", "variance", "covariance", "accel",  "acceleration", "gyro", "euler", "error"};

template <std::size_t N>
bool is_in(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

bool is_neutral(const std::string& word) { return is_in(kNeutralWords, word); }

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// In lower case; a capital letter after a small one begins a word, as in "posX".
Words words_of(std::string_view text) {
  Words words;
  char before = ' ';
  for (const char c : text) {
    const bool begins =
        !(is_upper(before) || is_lower(before) || is_digit(before)) || (is_upper(c) && is_lower(before));
    if (is_upper(c) || is_lower(c) || is_digit(c)) {
      if (begins) words.emplace_back();
      words.back() += is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    }
    before = c;
  }
  return words;
}

std::optional<io::TimeUnit> time_unit(std::string_view word) {
  constexpr std::array<std::string_view, 5> kSeconds = {"s", "sec", "secs", "second", "seconds"};
  constexpr std::array<std::string_view, 4> kMilli = {"ms", "msec", "millisecond", "milliseconds"};
  constexpr std::array<std::string_view, 5> kMicro = {"us", "usec", "microsecond", "microseconds", "usecs"};
  constexpr std::array<std::string_view, 7> kNano = {"ns",       "nsec",       "nsecs",      "nanosec",
                                                     "nanosecs", "nanosecond", "nanoseconds"};
  if (is_in(kNano, word)) return io::TimeUnit::nanoseconds;
  if (is_in(kMicro, word)) return io::TimeUnit::microseconds;
  if (is_in(kMilli, word)) return io::TimeUnit::milliseconds;
  if (is_in(kSeconds, word)) return io::TimeUnit::seconds;
  return std::nullopt;
}

std::optional<double> metres_per(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, double>, 8> kUnits = {{{"m", 1.0},
                                                                          {"meter", 1.0},
                                                                          {"meters", 1.0},
                                                                          {"metre", 1.0},
                                                                          {"metres", 1.0},
                                                                          {"mm", 1e-3},
                                                                          {"cm", 1e-2},
                                                                          {"km", 1e3}}};
  const auto found = std::ranges::find(kUnits, word, [](const auto& unit) { return unit.first; });
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

/// A name taken apart: "p_RS_R_x [m]" is p, rs, r, x and m.
struct ColumnName {
  Words words;
  std::string unit;
};

ColumnName taken_apart(std::string_view name) {
  const std::size_t bracket = std::min(name.find_first_of("[({"), name.size());
  ColumnName parts{words_of(name.substr(0, bracket)), {}};
  const Words unit = words_of(name.substr(bracket));
  if (unit.size() == 1) parts.unit = unit.front();
  const bool has_unit_word = parts.words.size() >= 2 && unit.empty() &&
                             (time_unit(parts.words.back()) || metres_per(parts.words.back()));
  if (has_unit_word) {
    parts.unit = parts.words.back();
    parts.words.pop_back();
    if (parts.words.back() == "in" && parts.words.size() >= 2) parts.words.pop_back();
  } else if (parts.words.size() == 1 && parts.words[0].size() > 1 && time_unit(parts.words[0])) {
    parts = {{"t"}, parts.words[0]};  // "sec"
  }
  return parts;
}

enum class Role { none, position, quaternion };

/// What the words before the axis say; bare axes, as of "x", are those of positions.
Role role_of(std::span<const std::string> words) {
  if (std::ranges::any_of(words,
                          [](const auto& word) { return word.size() > 1 && is_in(kOtherWords, word); }))
    return Role::none;
  while (!words.empty() && is_neutral(words.front())) words = words.subspan(1);
  if (words.empty()) return Role::position;
  if (is_in(kPositionWords, words.front())) return Role::position;
  if (is_in(kQuaternionWords, words.front())) return Role::quaternion;
  if (is_in(kOtherWords, words.front())) return Role::none;
  if (is_in(kPositionWords, words.back()) && words.back().size() > 1) return Role::position;
  if (is_in(kQuaternionWords, words.back()) && words.back().size() > 1) return Role::quaternion;
  return Role::none;
}

/// One of the seven numbers of a pose: x, y and z of the position, x, y, z and w of the quaternion.
struct PoseNumber {
  std::size_t index = 0;
  bool bare = false;  ///< only an axis is named
};

std::optional<PoseNumber> pose_number(const Words& words) {
  constexpr std::string_view kAxes = "xyzw";
  if (words.empty()) return std::nullopt;
  const std::string& last = words.back();
  const std::size_t axis = kAxes.find(last.back());
  if (axis == kAxes.npos) return std::nullopt;
  const std::span<const std::string> before(words.data(), words.size() - 1);
  Role role = Role::none;
  if (last.size() == 1) {
    role = role_of(before);
  } else if (std::ranges::all_of(before, is_neutral)) {
    const std::string_view prefix = std::string_view(last).substr(0, last.size() - 1);
    role = is_in(kPositionWords, prefix)     ? Role::position
           : is_in(kQuaternionWords, prefix) ? Role::quaternion
                                             : Role::none;
  }
  if (role == Role::none || (role == Role::position && axis == 3)) return std::nullopt;
  const bool bare = last.size() == 1 && std::ranges::all_of(before, is_neutral);
  return PoseNumber{role == Role::position ? axis : 3 + axis, bare};
}

/// How well a name says that a column is the stamp; 0: it does not.
int stamp_rank(const Words& words) {
  constexpr std::array<std::pair<std::string_view, int>, 7> kRanks = {
      {{"timestamp", 4}, {"timestamps", 4}, {"stamp", 4}, {"time", 3}, {"times", 3}, {"ts", 2}, {"t", 1}}};
  if (words.empty()) return 0;
  const auto rank = std::ranges::find(kRanks, words.back(), [](const auto& entry) { return entry.first; });
  if (rank == kRanks.end()) return 0;
  bool of_header = false;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (!is_neutral(words[i]) && !is_in(kClockWords, words[i])) return 0;
    of_header = of_header || words[i] == "header";
  }
  return of_header ? 5 : rank->second;
}

struct StampColumn {
  std::size_t column = 0;
  int rank = 0;
  std::optional<io::TimeUnit> unit;
  Words words;
};

/// The best names first. True if these are the seconds of the stamp, and then its fraction. Error
/// data_corrupt: no name, or the best one in two other units.
Result<bool> sort_stamps(std::vector<StampColumn>& stamps, std::span<const std::string> names) {
  if (stamps.empty()) return fail(ErrorCode::data_corrupt, "no column is named as the stamp (timestamp)");
  std::ranges::stable_sort(stamps, std::ranges::greater(), &StampColumn::rank);
  const auto half = std::ranges::find_if(stamps, [&](const StampColumn& other) {
    return other.words == stamps[0].words && other.unit != stamps[0].unit;
  });
  if (half == stamps.end()) return false;
  std::iter_swap(stamps.begin() + 1, half);
  if (stamps[1].unit == io::TimeUnit::seconds) std::swap(stamps[0], stamps[1]);
  if (stamps[0].unit == io::TimeUnit::seconds && stamps[1].unit) return true;
  return fail(ErrorCode::data_corrupt,
              fmt::format("the stamp is in two columns: {} and {}", printable(names[stamps[0].column]),
                          printable(names[stamps[1].column])),
              "write each stamp into one column, in one unit");
}

constexpr std::array<std::string_view, 7> kValues = {
    "the x of the position (tx)",   "the y of the position (ty)",   "the z of the position (tz)",
    "the x of the quaternion (qx)", "the y of the quaternion (qy)", "the z of the quaternion (qz)",
    "the w of the quaternion (qw)"};

/// The columns of the seven numbers.
class PoseNumbers {
 public:
  /// False if another column has the same number.
  bool take(const PoseNumber& number, std::size_t column, std::string_view unit) {
    Column& kept = columns_[number.index];
    if (kept.taken && kept.bare == number.bare) return false;
    if (kept.taken && number.bare) return true;
    kept = {true, number.bare, column, metres_per(unit).value_or(1)};
    return true;
  }

  [[nodiscard]] Result<PoseColumns> columns() const {
    PoseColumns result;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!columns_[i].taken)
        return fail(ErrorCode::data_corrupt, fmt::format("no column is named as {}", kValues[i]));
      (i < 3 ? result.position[i] : result.quaternion[i - 3]) = columns_[i].column;
    }
    result.metres_per_unit = columns_[0].metres;
    if (columns_[1].metres != columns_[0].metres || columns_[2].metres != columns_[0].metres)
      return fail(ErrorCode::data_corrupt, "the columns of the position have different units");
    return result;
  }

  [[nodiscard]] std::size_t column_of(std::size_t index) const { return columns_[index].column; }

 private:
  struct Column {
    bool taken = false;
    bool bare = false;
    std::size_t column = 0;
    double metres = 1;
  };
  std::array<Column, 7> columns_;
};

}  // namespace

std::size_t PoseColumns::needed() const {
  return 1 + std::max({stamp, fraction.value_or(0), *std::ranges::max_element(position),
                       *std::ranges::max_element(quaternion)});
}

bool PoseColumns::same_places(const PoseColumns& other) const {
  return stamp == other.stamp && fraction == other.fraction && position == other.position &&
         quaternion == other.quaternion;
}

Result<NamedColumns> columns_by_name(std::span<const std::string> names) {
  PoseNumbers numbers;
  std::vector<StampColumn> stamps;
  for (std::size_t column = 0; column < names.size(); ++column) {
    const ColumnName name = taken_apart(names[column]);
    if (const int rank = stamp_rank(name.words); rank > 0)
      stamps.push_back({column, rank, time_unit(name.unit), name.words});
    const auto number = pose_number(name.words);
    if (number && !numbers.take(*number, column, name.unit))
      return fail(ErrorCode::data_corrupt,
                  fmt::format("two columns are named as {}: {} and {}", kValues[number->index],
                              printable(names[numbers.column_of(number->index)]), printable(names[column])));
  }
  const auto in_two = sort_stamps(stamps, names);
  if (!in_two) return tl::unexpected(in_two.error());
  auto columns = numbers.columns();
  if (!columns) return tl::unexpected(columns.error());
  columns->stamp = stamps.front().column;
  columns->unit = stamps.front().unit;
  if (*in_two) {
    columns->fraction = stamps[1].column;
    columns->fraction_unit = *stamps[1].unit;
  }
  const std::size_t other = *in_two ? 2 : 1;
  return NamedColumns{*columns,
                      stamps.size() > other ? printable(names[stamps[other].column]) : std::string()};
}

}  // namespace fusebench::trajectory
