#include "eval/record/run_files/record_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "core/base/io/fingerprint.hpp"
#include "eval/record/profile/trace_file.hpp"

namespace fusebench::run_files {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRecordName = "record.json";

Result<std::string> hash_of(const fs::path& file) {
  io::Fingerprint content;
  if (auto added = content.add_file(file); !added) return tl::unexpected(added.error());
  return content.hex();
}

/// Every file below a folder but the record, by name.
Result<std::vector<record::RecordedFile>> files_in(const fs::path& folder) {
  std::vector<record::RecordedFile> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->is_regular_file(error)) continue;
    const std::string name = entry->path().lexically_relative(folder).generic_string();
    if (name == kRecordName) continue;
    const auto bytes = entry->file_size(error);
    auto hash = hash_of(entry->path());
    if (!hash) return tl::unexpected(hash.error());
    if (!error) files.push_back({name, bytes, std::move(*hash)});
  }
  if (error) {
    return fail(ErrorCode::io, fmt::format("{}: cannot be read back: {}", folder.string(), error.message()));
  }
  std::ranges::sort(files, {}, &record::RecordedFile::name);
  return files;
}

const record::RecordedFile* recorded_file(const record::RunRecord& record, std::string_view name) {
  for (const auto* files : {&record.files, &record.timing.files}) {
    const auto found = std::ranges::find(*files, name, &record::RecordedFile::name);
    if (found != files->end()) return &*found;
  }
  return nullptr;
}

}  // namespace

Result<void> commit_run(io::StagedFolder& folder, record::RunRecord& record, std::string_view varying) {
  auto files = files_in(folder.path());
  if (!files) return fail(ErrorCode::io, files.error().message);
  record.files.clear();
  record.timing.files.clear();
  for (record::RecordedFile& file : *files) {
    const bool varies = file.name == "frames.csv" || file.name == profile::kTraceFile || file.name == varying;
    (varies ? record.timing.files : record.files).push_back(std::move(file));
  }
  record::fail_if_not_finite(record);
  if (auto written = folder.write(kRecordName, record::to_json(record)); !written) return written;
  return folder.commit();
}

std::string damage_text(std::string_view file, std::string_view problem) {
  return fmt::format("{} is damaged: {}; run it again", file, problem);
}

std::string changed_size(const fs::path& run, std::span<const record::RecordedFile> files) {
  for (const record::RecordedFile& file : files) {
    std::error_code error;
    const auto bytes = fs::file_size(run / file.name, error);
    if (!error && bytes != file.bytes)
      return damage_text(file.name, fmt::format("{} bytes of {}", bytes, file.bytes));
  }
  return {};
}

std::string changed_size(const fs::path& run, const record::RunRecord& record) {
  std::string text = changed_size(run, record.files);
  return text.empty() ? changed_size(run, record.timing.files) : text;
}

std::vector<std::string> missing_files(const fs::path& run, const record::RunRecord& record) {
  std::vector<std::string> missing;
  for (const auto* files : {&record.files, &record.timing.files}) {
    for (const record::RecordedFile& file : *files) {
      std::error_code ignored;
      if (!fs::exists(run / file.name, ignored)) missing.push_back(file.name);
    }
  }
  return missing;
}

Result<void> check_file(const fs::path& run, const record::RunRecord& record, std::string_view name) {
  const record::RecordedFile* const recorded = recorded_file(record, name);
  if (recorded == nullptr) return {};
  if (const std::string text = changed_size(run, std::span(recorded, 1)); !text.empty())
    return fail(ErrorCode::data_corrupt, text);
  const auto hash = hash_of(run / name);
  if (!hash) return tl::unexpected(hash.error());
  if (*hash == recorded->xxh3) return {};
  return fail(ErrorCode::data_corrupt, damage_text(name, "its content is not what the run wrote"));
}

Result<void> check_files(const fs::path& run, const record::RunRecord& record) {
  for (const auto* files : {&record.files, &record.timing.files}) {
    for (const record::RecordedFile& file : *files) {
      std::error_code ignored;
      if (!fs::exists(run / file.name, ignored)) continue;
      if (auto checked = check_file(run, record, file.name); !checked) return checked;
    }
  }
  return {};
}

}  // namespace fusebench::run_files
