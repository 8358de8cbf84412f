#include "eval/suites/recording_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/open_recording.hpp"

namespace fusebench::suites {

namespace fs = std::filesystem;

namespace {

/// The folders in a folder, except hidden ones.
std::vector<fs::path> folders_in(const fs::path& parent, std::error_code& error) {
  std::vector<fs::path> folders;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) && !entry->path().filename().string().starts_with('.')) {
      folders.push_back(entry->path());
    }
  }
  return folders;
}

/// A recording of the catalogue that is not under `data`.
tl::unexpected<Error> not_there(const calibration::CatalogueEntry& entry, const fs::path& data) {
  const std::string folder = (data / entry.folders.front()).string();
  return fail(
      ErrorCode::data_missing,
      fmt::format("{} ({}) is a known recording, but there is no folder {}", entry.name, entry.title, folder),
      entry.downloads.empty()
          ? fmt::format("{}; unpack it to {}", entry.download_note, folder)
          : fmt::format("fetch it with scripts/fetch_datasets.sh {} --data {}", entry.name, data.string()));
}

/// The recording under `data` whose folder has that name, or an error that names the nearest.
Result<fs::path> find_folder_named(const std::string& name, const fs::path& data) {
  std::vector<std::string> present;
  const auto folders = recordings_under(data);
  std::error_code ignored;
  if (!fs::is_directory(data, ignored)) return tl::unexpected(folders.error());
  if (folders) {
    for (const fs::path& folder : *folders) {
      if (folder.filename() == name) return folder;
      present.push_back(folder.filename().string());
    }
  }
  std::vector<std::string_view> known(present.begin(), present.end());
  for (const calibration::CatalogueEntry& entry : calibration::recording_catalogue())
    known.push_back(entry.name);
  const std::string there = present.empty()
                                ? "there are none under --data"
                                : fmt::format("under --data there are: {}", fmt::join(present, ", "));
  const std::string nearest = did_you_mean(name, known);
  return fail(ErrorCode::data_missing, fmt::format("no recording '{}' here or under {}", name, data.string()),
              nearest.empty() ? there : nearest + " " + there);
}

}  // namespace

Result<std::vector<fs::path>> recordings_under(const fs::path& data) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (const fs::path& folder : folders_in(data, error)) {
    if (datasets::recognise_format(folder)) {
      folders.push_back(folder);
      continue;
    }
    std::error_code ignored;  // a folder that may not be read holds nothing for us
    for (const fs::path& inner : folders_in(folder, ignored)) {
      if (datasets::recognise_format(inner)) folders.push_back(inner);
    }
  }
  if (error) {
    return fail(ErrorCode::data_missing,
                fmt::format("{}: cannot be listed: {}", data.string(), error.message()),
                "--data or FUSEBENCH_DATA names the folder of recordings");
  }
  if (folders.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: holds no recordings", data.string()),
                "scripts/fetch_datasets.sh downloads published ones; `fusebench list recordings` names them");
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

Result<std::vector<fs::path>> find_recordings(const std::string& name, const fs::path& data) {
  if (!name.ends_with('*')) {
    auto folder = find_recording(name, data);
    if (!folder) return tl::unexpected(folder.error());
    return std::vector<fs::path>{std::move(*folder)};
  }
  const std::string beginning = name.substr(0, name.size() - 1);
  std::vector<fs::path> found;
  const auto folders = recordings_under(data);
  std::error_code ignored;
  if (!data.empty() && !fs::is_directory(data, ignored)) return tl::unexpected(folders.error());
  if (folders) {
    for (const fs::path& folder : *folders) {
      if (folder.filename().string().starts_with(beginning)) found.push_back(folder);
    }
  }
  if (!found.empty()) return found;
  return fail(ErrorCode::data_missing,
              fmt::format("no recording whose name begins with '{}' under '{}'", beginning, data.string()),
              "--data or FUSEBENCH_DATA names the folder of recordings; scripts/fetch_datasets.sh downloads "
              "published ones, and --only recording=TEXT leaves out those without TEXT in their name");
}

Result<fs::path> find_recording(const std::string& name, const fs::path& data) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored) || fs::is_regular_file(name, ignored)) {
    // "folder/" and "." have no last name.
    const fs::path folder = fs::weakly_canonical(name, ignored);
    return ignored ? fs::path(name) : folder;
  }
  const calibration::CatalogueEntry* entry = calibration::find_catalogue_entry(name);
  if (data.empty()) {
    return fail(ErrorCode::data_missing,
                entry == nullptr
                    ? fmt::format("{}: no such folder", name)
                    : fmt::format("{} is a known recording, but no folder of recordings is given", name),
                "--data or FUSEBENCH_DATA names the folder of recordings");
  }
  if (fs::is_directory(data / name, ignored) || fs::is_regular_file(data / name, ignored)) return data / name;
  if (entry != nullptr) {
    const auto folder = calibration::catalogue_folder(*entry, data);
    if (folder) return *folder;
    return not_there(*entry, data);
  }
  return find_folder_named(name, data);
}

}  // namespace fusebench::suites
