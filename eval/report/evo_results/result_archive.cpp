#include "eval/report/evo_results/result_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/printable.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/report/evo_results/zip_archive.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::evo_results {

namespace {

using Json = nlohmann::ordered_json;

/// A path below the archive's root, whatever unpacks it: "../runs/est.txt" is "runs/est.txt".
std::string entry_name(const std::string& file, const char* ending) {
  std::filesystem::path inside;
  for (const std::filesystem::path& part : std::filesystem::path(file).relative_path()) {
    if (part != ".." && part != ".") inside /= part;
  }
  return inside.generic_string() + ending;
}

tl::unexpected<Error> no_result(const std::filesystem::path& file, const std::string& what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what),
              "a result is a .zip file that evo's or this program's --save_results wrote");
}

const ZipEntry* find(const std::vector<ZipEntry>& entries, std::string_view name) {
  const auto found = std::ranges::find(entries, name, &ZipEntry::name);
  return found == entries.end() ? nullptr : &*found;
}

/// An object; nothing if it is anything else.
std::optional<Json> parsed_object(const std::vector<ZipEntry>& entries, std::string_view name) {
  const ZipEntry* const entry = find(entries, name);
  if (entry == nullptr) return std::nullopt;
  Json json = Json::parse(entry->bytes, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  return json;
}

/// Of somebody's archive: what a terminal would obey is shown as '?'.
std::string text_of(const Json& info, const char* key) {
  if (!info.contains(key) || !info[key].is_string()) return "";
  auto text = info[key].get<std::string>();
  const auto obeyed = [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == 0x7F; };
  std::ranges::replace_if(text, obeyed, '?');
  return text;
}

bool all_finite(const NpyArray& array) {
  return std::ranges::all_of(array.values, [](double value) { return std::isfinite(value); });
}

}  // namespace

Result<std::string> archive_of(const EvoResult& result) {
  const Json info = {{"title", result.title},
                     {"ref_name", result.reference_name},
                     {"est_name", result.estimate_name},
                     {"label", result.label}};
  Json stats = Json::object();
  for (const auto& [name, value] : result.stats) stats[name] = value;
  std::vector<ZipEntry> entries = {{"info.json", text::json_text(info, -1)},
                                   {"stats.json", text::json_text(stats, -1)}};
  for (const auto& [name, array] : result.arrays) entries.push_back({name + ".npy", npy_bytes(array)});
  for (const NamedTrajectory& trajectory : result.trajectories) {
    std::string name = entry_name(trajectory.name, trajectory.has_stamps ? ".tum" : ".kitti");
    while (find(entries, name) != nullptr) name = "estimate/" + name;  // a file against itself
    entries.push_back({std::move(name), trajectory.has_stamps
                                            ? trajectory::tum_text(trajectory.poses)
                                            : trajectory_files::kitti_text(trajectory.poses)});
  }
  return zip_bytes(entries);
}

Result<EvoResult> read_result(const std::filesystem::path& file) {
  const auto entries = read_zip(file);
  if (!entries) return tl::unexpected(entries.error());
  const auto info = parsed_object(*entries, "info.json");
  const auto stats = parsed_object(*entries, "stats.json");
  if (!info || !stats)
    return no_result(file, "has no info.json and stats.json, which describe the comparison");
  EvoResult result;
  result.title = text_of(*info, "title");
  result.reference_name = text_of(*info, "ref_name");
  result.estimate_name = text_of(*info, "est_name");
  result.label = text_of(*info, "label");
  for (const auto& [name, value] : stats->items()) {
    if (!value.is_number())
      return no_result(file, fmt::format("stats.json: {} is no number", printable(name)));
    result.stats.emplace_back(name, value.get<double>());
  }
  for (const ZipEntry& entry : *entries) {
    // Older versions of evo called arrays .npz.
    if (!entry.name.ends_with(".npy") && !entry.name.ends_with(".npz")) continue;
    auto array = parse_npy(entry.bytes, fmt::format("{}: {}", file.string(), printable(entry.name)));
    if (!array) return tl::unexpected(array.error());
    if (!all_finite(*array))
      return no_result(file, fmt::format("{}: a value is not finite", printable(entry.name)));
    result.arrays.emplace_back(entry.name.substr(0, entry.name.size() - 4), std::move(*array));
  }
  const NpyArray* const errors = result.array("error_array");
  if (errors == nullptr || errors->shape.size() != 1 || errors->values.empty() || result.stats.empty())
    return no_result(file, "has no errors (error_array.npy) or no statistics of them");
  return result;
}

}  // namespace fusebench::evo_results
