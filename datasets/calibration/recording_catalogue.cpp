#include "datasets/calibration/recording_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>
#include <variant>

#include "core/base/nearest_name.hpp"
#include "core/config/toml_document.hpp"

namespace fusebench::calibration {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRecording = "recording";
constexpr std::string_view kCalibration = "calibration";

Result<void> read_text(const config::TomlEntry& entry, std::string& text) {
  const auto* value = config::plain_value<std::string>(entry);
  if (value == nullptr || value->empty()) return config::wrong_value(entry, "a text that is not empty");
  text = *value;
  return {};
}

Result<void> read_texts(const config::TomlEntry& entry, std::vector<std::string>& texts) {
  const auto* list = std::get_if<config::TomlList>(&entry.value);
  if (list == nullptr || list->empty())
    return config::wrong_value(entry, "a list of texts that is not empty");
  for (const config::OptionValue& value : *list) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr || text->empty()) return config::wrong_value(entry, "a list of texts");
    texts.push_back(*text);
  }
  return {};
}

Result<void> read_count(const config::TomlEntry& entry, std::optional<std::int64_t>& count) {
  const auto* value = config::plain_value<std::int64_t>(entry);
  if (value == nullptr || *value < 1) return config::wrong_value(entry, "a positive integer");
  count = *value;
  return {};
}

Result<void> read_duration(const config::TomlEntry& entry, std::optional<double>& duration) {
  const auto* value = config::plain_value<double>(entry);
  if (value == nullptr || !(*value > 0)) return config::wrong_value(entry, "a positive number of seconds");
  duration = *value;
  return {};
}

Result<void> read_digest(const config::TomlEntry& entry, std::string& digest) {
  if (auto text = read_text(entry, digest); !text) return text;
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (digest.size() != 64 || !std::ranges::all_of(digest, is_hex)) {
    return config::wrong_value(entry, "64 lower-case hexadecimal digits");
  }
  return {};
}

Result<void> read_format(const config::TomlEntry& entry, std::string& format) {
  if (auto text = read_text(entry, format); !text) return text;
  if (format != "tum" && format != "icl" && format != "zr300" && format != "eth3d") {
    return config::wrong_value(entry, "\"tum\", \"icl\", \"zr300\" or \"eth3d\"");
  }
  return {};
}

Result<void> read_kind(const config::TomlEntry& entry) {
  const auto* kind = config::plain_value<std::string>(entry);
  if (kind == nullptr || *kind != kRecording) return config::wrong_value(entry, "\"recording\"");
  return {};
}

Result<void> read_entry(const config::TomlEntry& entry, CatalogueEntry& recording) {
  if (entry.key == "kind") return read_kind(entry);
  if (entry.key == "format") return read_format(entry, recording.format);
  if (entry.key == "archive_sha256") return read_digest(entry, recording.archive_sha256);
  if (entry.key == "duration_s") return read_duration(entry, recording.duration_s);
  const std::pair<std::string_view, std::string*> texts[] = {{"name", &recording.name},
                                                             {"title", &recording.title},
                                                             {"family", &recording.family},
                                                             {"page", &recording.page},
                                                             {"licence", &recording.licence},
                                                             {"camera", &recording.camera},
                                                             {kCalibration, &recording.calibration},
                                                             {"download_note", &recording.download_note}};
  for (const auto& [key, text] : texts) {
    if (entry.key == key) return read_text(entry, *text);
  }
  const std::pair<std::string_view, std::vector<std::string>*> lists[] = {
      {"folders", &recording.folders},
      {"download", &recording.downloads},
      {"unverified", &recording.unverified}};
  for (const auto& [key, list] : lists) {
    if (entry.key == key) return read_texts(entry, *list);
  }
  const std::pair<std::string_view, std::optional<std::int64_t>*> counts[] = {
      {"archive_bytes", &recording.archive_bytes},
      {"color_images", &recording.color_images},
      {"depth_images", &recording.depth_images},
      {"frames", &recording.frames}};
  for (const auto& [key, count] : counts) {
    if (entry.key == key) return read_count(entry, *count);
  }
  return fail(ErrorCode::configuration, fmt::format("{}: unknown key '{}'", entry.place, entry.key));
}

Result<void> check_entry(const CatalogueEntry& entry, const std::string& file) {
  const auto lacks = [&](std::string_view what) {
    return fail(ErrorCode::configuration, fmt::format("{}: {}", file, what));
  };
  const std::pair<std::string_view, bool> required[] = {
      {"name", entry.name.empty()},      {"title", entry.title.empty()},     {"family", entry.family.empty()},
      {"format", entry.format.empty()},  {"folders", entry.folders.empty()}, {"page", entry.page.empty()},
      {"licence", entry.licence.empty()}};
  for (const auto& [key, missing] : required) {
    if (missing) return lacks(fmt::format("the key '{}' is missing", key));
  }
  if (entry.downloads.empty() == entry.download_note.empty())
    return lacks("either download or download_note is needed");
  if (entry.downloads.size() != 1 && (entry.archive_bytes || !entry.archive_sha256.empty())) {
    return lacks("archive_bytes and archive_sha256 belong to a single archive");
  }
  if (!entry.camera.empty() && !entry.calibration.empty())
    return lacks("either camera or calibration, not both");
  return {};
}

/// What the files hold, told apart by their kind.
struct Catalogue {
  std::vector<CatalogueEntry> recordings;                          ///< by name
  std::map<std::string, CatalogueFile, std::less<>> calibrations;  ///< file of each calibration
};

std::string_view text_of(const config::TomlDocument& document, std::string_view key) {
  for (const config::TomlEntry& entry : document.entries) {
    if (entry.key != key) continue;
    const auto* text = config::plain_value<std::string>(entry);
    return text == nullptr ? std::string_view() : *text;
  }
  return {};
}

// The files are part of the binary and a test reads each, so a broken one is a bug and not bad input.
Catalogue read_catalogue() {
  Catalogue catalogue;
  for (const CatalogueFile& file : catalogue_files()) {
    const auto document = config::parse_toml(file.text, std::string(file.name));
    check(document.has_value(), document ? "" : document.error().message.c_str());
    if (text_of(*document, "kind") == kCalibration) {
      catalogue.calibrations.emplace(text_of(*document, "name"), file);
      continue;
    }
    auto entry = parse_catalogue_entry(file.text, std::string(file.name));
    check(entry.has_value(), entry ? "" : entry.error().message.c_str());
    catalogue.recordings.push_back(std::move(*entry));
  }
  std::ranges::sort(catalogue.recordings, {}, &CatalogueEntry::name);
  return catalogue;
}

const Catalogue& catalogue() {
  static const Catalogue kCatalogue = read_catalogue();
  return kCatalogue;
}

/// Whether the last components of the path are those of `tail`.
bool ends_with(const fs::path& path, const fs::path& tail) {
  auto component = path.end();
  auto wanted = tail.end();
  while (wanted != tail.begin()) {
    if (component == path.begin()) return false;
    if (*--component != *--wanted) return false;
  }
  return true;
}

}  // namespace

Result<CatalogueEntry> parse_catalogue_entry(std::string_view text, const std::string& file) {
  const auto document = config::parse_toml(text, file);
  if (!document) return tl::unexpected(document.error());
  if (!document->tables.empty()) {
    const config::TomlTable& table = document->tables.front();
    return fail(ErrorCode::configuration, fmt::format("{}: unknown table [{}]", table.place, table.key));
  }
  CatalogueEntry recording;
  for (const config::TomlEntry& entry : document->entries) {
    if (auto read = read_entry(entry, recording); !read) return tl::unexpected(read.error());
  }
  if (auto complete = check_entry(recording, file); !complete) return tl::unexpected(complete.error());
  return recording;
}

std::span<const CatalogueEntry> recording_catalogue() { return catalogue().recordings; }

const CatalogueEntry* find_catalogue_entry(std::string_view name) {
  const auto all = recording_catalogue();
  const auto found = std::ranges::find(all, name, &CatalogueEntry::name);
  return found == all.end() ? nullptr : &*found;
}

const CatalogueEntry* catalogue_entry_of_folder(const fs::path& folder) {
  fs::path path = folder.lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // "data/dorm1_slow/"
  for (const CatalogueEntry& entry : recording_catalogue()) {
    if (std::ranges::any_of(entry.folders, [&](const std::string& tail) { return ends_with(path, tail); })) {
      return &entry;
    }
  }
  return nullptr;
}

std::optional<fs::path> catalogue_folder(const CatalogueEntry& entry, const fs::path& data) {
  if (data.empty()) return std::nullopt;
  for (const std::string& folder : entry.folders) {
    std::error_code ignored;
    if (fs::is_directory(data / folder, ignored)) return data / folder;
  }
  return std::nullopt;
}

Result<RigCalibration> catalogue_calibration(std::string_view name) {
  const auto found = catalogue().calibrations.find(name);
  if (found == catalogue().calibrations.end()) {
    std::vector<std::string_view> names;
    for (const auto& [known, file] : catalogue().calibrations) names.push_back(known);
    return fail(ErrorCode::configuration, fmt::format("no calibration '{}' in configs/recordings", name),
                did_you_mean(name, names));
  }
  const std::string file(found->second.name);
  const auto document = config::parse_toml(found->second.text, file);
  if (!document) return tl::unexpected(document.error());
  return rig_calibration(*document, file);
}

}  // namespace fusebench::calibration
