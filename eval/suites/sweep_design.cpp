#include "eval/suites/sweep_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <random>
#include <set>

#include "core/base/nearest_name.hpp"
#include "core/config/toml_document.hpp"

namespace fusebench::suites {

namespace {

constexpr std::size_t kMostPoints = kMostRuns;
constexpr std::array<std::pair<std::string_view, SweepDesign>, 4> kDesigns = {
    {{"grid", SweepDesign::grid},
     {"zip", SweepDesign::zip},
     {"random", SweepDesign::random},
     {"latin-hypercube", SweepDesign::latin_hypercube}}};
constexpr std::array<std::string_view, 4> kRangeKeys = {"from", "to", "steps", "scale"};

bool draws(SweepDesign design) {
  return design == SweepDesign::random || design == SweepDesign::latin_hypercube;
}

tl::unexpected<Error> wrong(const std::string& place, std::string text, std::string hint = "") {
  return fail(ErrorCode::configuration, fmt::format("{}: {}", place, text), std::move(hint));
}

bool is_integer_option(const std::string& key) {
  for (const config::OptionRow& row : config::describe_options(config::EffectiveConfig{}.values())) {
    if (row.key == key) return row.type == "integer";
  }
  return false;
}

Result<void> check_option(const std::string& key, const std::string& place) {
  std::vector<std::string> names;
  for (const config::OptionRow& row : config::describe_options(config::EffectiveConfig{}.values()))
    names.push_back(row.key);
  if (std::ranges::find(names, key) != names.end()) return {};
  return wrong(place, fmt::format("unknown option '{}' in a sweep{}", key, nearest_hint(key, names)),
               "`fusebench list options` names them; other keys of [[sweep]] are design, samples and seed");
}

SweepAxis& axis_of(SweepBlock& block, const std::string& key, const std::string& place) {
  const auto found = std::ranges::find(block.axes, key, &SweepAxis::key);
  if (found != block.axes.end()) return *found;
  block.axes.push_back({key, {}, {}, place});
  return block.axes.back();
}

/// "tsdf.voxel_m.from" is a part of the range of tsdf.voxel_m.
std::optional<std::pair<std::string, std::string>> range_key(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  const std::string last = key.substr(dot + 1);
  if (std::ranges::find(kRangeKeys, last) == kRangeKeys.end()) return std::nullopt;
  return std::pair(key.substr(0, dot), last);
}

Result<void> read_range(const config::TomlEntry& entry, const std::string& last, SweepAxis::Range& range) {
  if (last == "scale") {
    const auto text = plain_entry<std::string>(entry);
    if (!text || (*text != "linear" && *text != "log")) return wrong_entry(entry, "\"linear\" or \"log\"");
    range.log = *text == "log";
    return {};
  }
  if (last == "steps") {
    const auto steps = count_entry(entry);
    if (!steps || *steps < 2) return wrong_entry(entry, "an integer, 2 or more");
    range.steps = *steps;
    return {};
  }
  const auto number = number_entry(entry);
  if (!number) return tl::unexpected(number.error());
  (last == "from" ? range.from : range.to) = *number;
  return {};
}

Result<void> read_entry(const config::TomlEntry& entry, SweepBlock& block) {
  if (entry.key == "design") {
    const auto text = plain_entry<std::string>(entry);
    const auto found =
        std::ranges::find_if(kDesigns, [&](const auto& d) { return text && d.first == *text; });
    if (found == kDesigns.end())
      return wrong_entry(entry, "\"grid\", \"zip\", \"random\" or \"latin-hypercube\"");
    block.design = found->second;
    return {};
  }
  if (entry.key == "samples" || entry.key == "seed") {
    const auto count = count_entry(entry);
    if (!count) return tl::unexpected(count.error());
    if (entry.key == "seed") block.seed = *count;
    if (entry.key == "samples") block.samples = *count;
    return {};
  }
  if (const auto range = range_key(entry.key)) {
    if (auto known = check_option(range->first, entry.place); !known) return known;
    SweepAxis& axis = axis_of(block, range->first, entry.place);
    if (!axis.range) axis.range.emplace();
    return read_range(entry, range->second, *axis.range);
  }
  if (auto known = check_option(entry.key, entry.place); !known) return known;
  const auto* list = std::get_if<config::TomlList>(&entry.value);
  if (list == nullptr || list->empty())
    return wrong_entry(entry, "a list of values, or a range { from, to, steps, scale }");
  axis_of(block, entry.key, entry.place).values = *list;
  return {};
}

/// Each value must be one that the option takes, before hours are spent on the runs before it.
Result<void> check_values(const SweepAxis& axis) {
  config::EffectiveConfig scratch;
  for (const config::OptionValue& value : axis.values) {
    if (auto set = scratch.set(axis.key, value, axis.place); !set) return set;
  }
  return {};
}

Result<void> check_axis(const SweepAxis& axis, SweepDesign design) {
  if (!axis.range) return check_values(axis);
  const SweepAxis::Range& range = *axis.range;
  if (std::isnan(range.from) || std::isnan(range.to))
    return wrong(axis.place,
                 fmt::format("the range of {} lacks {}", axis.key, std::isnan(range.from) ? "from" : "to"));
  if (draws(design) && range.steps > 0)
    return wrong(axis.place,
                 fmt::format("the range of {} has steps, and a design that draws has samples", axis.key));
  if (!(range.from < range.to))
    return wrong(axis.place, fmt::format("the range of {} is from {:g} to {:g}: from must be less", axis.key,
                                         range.from, range.to));
  if (range.log && !(range.from > 0))
    return wrong(axis.place, fmt::format("the logarithmic range of {} begins at {:g}: it must be positive",
                                         axis.key, range.from));
  if (!draws(design) && range.steps == 0)
    return wrong(axis.place, fmt::format("the range of {} lacks steps", axis.key), "steps = 5, for example");
  return {};
}

std::size_t size_of(const SweepAxis& axis) { return axis.range ? axis.range->steps : axis.values.size(); }

Result<void> check_block(const SweepBlock& block, const std::string& place) {
  if (block.axes.empty()) return wrong(place, "a [[sweep]] names no option");
  if (draws(block.design) != (block.samples > 0))
    return wrong(place, draws(block.design) ? "samples is missing (how many runs are drawn)"
                                            : "samples is for random and latin-hypercube designs");
  for (const SweepAxis& axis : block.axes) {
    if (auto good = check_axis(axis, block.design); !good) return good;
    if (block.design == SweepDesign::zip && size_of(axis) != size_of(block.axes.front())) {
      return wrong(axis.place,
                   fmt::format("{} has {} values and {} has {}: a zip takes lists of one length", axis.key,
                               size_of(axis), block.axes.front().key, size_of(block.axes.front())));
    }
  }
  return {};
}

/// Uniform in [0, 1), the same on every machine, unlike the distributions of the standard library.
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

double rounded(double value) {
  double result = value;
  const std::string text = fmt::format("{:.6g}", value);
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

/// The value of an axis at a share (0 to 1) of its range or list; whole: its option is an integer.
config::OptionValue value_at(const SweepAxis& axis, bool whole, double share) {
  if (!axis.range) {
    const auto size = static_cast<double>(axis.values.size());
    return axis.values[std::min(static_cast<std::size_t>(share * size), axis.values.size() - 1)];
  }
  const SweepAxis::Range& range = *axis.range;
  const double value = range.log ? range.from * std::pow(range.to / range.from, share)
                                 : range.from + share * (range.to - range.from);
  if (whole) return static_cast<std::int64_t>(std::llround(value));
  return rounded(value);
}

std::vector<config::OptionValue> values_of(const SweepAxis& axis) {
  if (!axis.range) return axis.values;
  std::vector<config::OptionValue> values;
  const bool whole = is_integer_option(axis.key);
  for (std::size_t i = 0; i < axis.range->steps; ++i)
    values.push_back(
        value_at(axis, whole, static_cast<double>(i) / static_cast<double>(axis.range->steps - 1)));
  return values;
}

std::vector<SweepPoint> grid_points(const SweepBlock& block) {
  std::vector<SweepPoint> points = {{}};
  for (const SweepAxis& axis : block.axes) {
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points) {
      for (const config::OptionValue& value : values_of(axis)) {
        longer.push_back(point);
        longer.back().emplace_back(axis.key, value);
      }
    }
    points = std::move(longer);
  }
  return points;
}

std::vector<SweepPoint> zipped_points(const SweepBlock& block) {
  std::vector<SweepPoint> points(size_of(block.axes.front()));
  for (const SweepAxis& axis : block.axes) {
    const auto values = values_of(axis);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].emplace_back(axis.key, values[i]);
  }
  return points;
}

std::vector<SweepPoint> drawn_points(const SweepBlock& block) {
  std::mt19937_64 random(block.seed);
  std::vector<SweepPoint> points(block.samples);
  for (const SweepAxis& axis : block.axes) {
    const bool whole = is_integer_option(axis.key);
    std::vector<std::size_t> parts(block.samples);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = i;
    for (std::size_t i = parts.size(); i > 1; --i) std::swap(parts[i - 1], parts[random() % i]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double share =
          block.design == SweepDesign::random
              ? unit(random)
              : (static_cast<double>(parts[i]) + unit(random)) / static_cast<double>(block.samples);
      points[i].emplace_back(axis.key, value_at(axis, whole, share));
    }
  }
  return points;
}

std::vector<SweepPoint> points_of(const SweepBlock& block) {
  if (draws(block.design)) return drawn_points(block);
  return block.design == SweepDesign::zip ? zipped_points(block) : grid_points(block);
}

/// How many points a block has, without making them.
double count_of(const SweepBlock& block) {
  if (draws(block.design)) return static_cast<double>(block.samples);
  if (block.design == SweepDesign::zip) return static_cast<double>(size_of(block.axes.front()));
  double count = 1;
  for (const SweepAxis& axis : block.axes) count *= static_cast<double>(size_of(axis));
  return count;
}

}  // namespace

Result<std::vector<SweepBlock>> read_sweeps(const std::vector<EntryTable>& tables) {
  std::vector<SweepBlock> blocks;
  std::set<std::string> swept;
  for (const EntryTable& table : tables) {
    SweepBlock block;
    for (const config::TomlEntry& entry : table.entries) {
      if (auto read = read_entry(entry, block); !read) return tl::unexpected(read.error());
    }
    if (auto good = check_block(block, table.place); !good) return tl::unexpected(good.error());
    for (const SweepAxis& axis : block.axes) {
      if (!swept.insert(axis.key).second)
        return wrong(axis.place, fmt::format("{} is swept twice", axis.key));
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

Result<std::optional<SweepBlock>> take_swept_sets(std::vector<std::string>& sets) {
  SweepBlock block;
  std::vector<std::string> plain;
  for (const std::string& set : sets) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos || set.find(',') == std::string::npos) {
      plain.push_back(set);
      continue;
    }
    SweepAxis axis{set.substr(0, equals), {}, {}, "--set " + set};
    if (auto known = check_option(axis.key, axis.place); !known) return tl::unexpected(known.error());
    for (std::size_t begin = equals + 1; begin <= set.size();) {
      const std::size_t end = std::min(set.find(',', begin), set.size());
      if (end == begin) return wrong(axis.place, "a value between commas is missing");
      axis.values.push_back(config::parse_option_value(std::string_view(set).substr(begin, end - begin)));
      begin = end + 1;
    }
    if (auto good = check_values(axis); !good) return tl::unexpected(good.error());
    block.axes.push_back(std::move(axis));
  }
  sets = std::move(plain);
  if (block.axes.empty()) return std::optional<SweepBlock>();
  return std::optional<SweepBlock>(std::move(block));
}

Result<std::vector<SweepPoint>> sweep_points(const std::vector<SweepBlock>& blocks) {
  double count = 1;
  for (const SweepBlock& block : blocks) count *= count_of(block);
  if (count > static_cast<double>(kMostPoints)) {
    return fail(ErrorCode::configuration,
                fmt::format("the sweep has {:.0f} points (allowed: up to {})", count, kMostPoints),
                "a latin-hypercube design covers many options with few points");
  }
  std::vector<SweepPoint> points = {{}};
  for (const SweepBlock& block : blocks) {
    const auto more = points_of(block);
    std::vector<SweepPoint> product;
    for (const SweepPoint& point : points) {
      for (const SweepPoint& added : more) {
        product.push_back(point);
        product.back().insert(product.back().end(), added.begin(), added.end());
      }
    }
    points = std::move(product);
  }
  std::set<std::string> seen;
  std::erase_if(points, [&](const SweepPoint& point) { return !seen.insert(to_string(point)).second; });
  return points;
}

std::string to_string(const SweepPoint& point) {
  std::string text;
  for (const auto& [key, value] : point) {
    const auto* plain = std::get_if<std::string>(&value);
    const auto* number = std::get_if<double>(&value);
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", key,
                        plain != nullptr    ? *plain
                        : number != nullptr ? fmt::format("{}", *number)
                                            : config::to_toml(value));
  }
  return text;
}

}  // namespace fusebench::suites
