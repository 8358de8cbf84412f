#include "eval/engine/run_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "core/staged_folder.hpp"
#include "eval/build_info.hpp"
#include "eval/engine/run_claim.hpp"
#include "eval/found_runs.hpp"
#include "eval/record.hpp"

namespace fusebench {

namespace {

namespace fs = std::filesystem;

std::uint64_t size_of(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) bytes += entry->file_size(ignored);
  }
  return bytes;
}

/// Under a hidden name first, so that a kill in the middle leaves no half of a run.
std::error_code remove_whole(const fs::path& folder) {
  std::error_code error;
  const fs::path hidden = folder.parent_path() / fmt::format(".{}.gc.tmp", folder.filename().string());
  fs::rename(folder, hidden, error);
  if (!error) fs::remove_all(hidden, error);
  return error;
}

bool is_garbage(const fs::path& folder, const RecordHead& head, const Garbage& garbage) {
  if (garbage.failed && head.status == RunStatus::failed) return true;
  if (!garbage.stale) return false;
  const auto record = read_record(folder / "record.json");
  // Imported runs come from elsewhere, and have no estimator of ours.
  return record && !record->config.empty() && record->provenance.estimator != build_info().estimator;
}

/// Where place_run() looks next for an identity whose first digits are another's there.
fs::path longer_place(const fs::path& target, const std::string& run_id) {
  constexpr std::size_t kDigits = 16;
  const std::string name = target.filename().string();
  const std::size_t repetition = name.find("-r");
  return target.parent_path() /
         (run_id.substr(0, kDigits) + (repetition == std::string::npos ? "" : name.substr(repetition)));
}

/// What was asked for goes along, so that failed runs can be run again there.
void copy_invocations(const fs::path& from, const fs::path& into) {
  std::error_code ignored;
  fs::create_directories(engine_folder(into), ignored);
  fs::copy(engine_folder(from) / "invocations", engine_folder(into) / "invocations",
           fs::copy_options::recursive | fs::copy_options::skip_existing, ignored);
}

Result<void> copy_run(const fs::path& from, const fs::path& to) {
  auto staged = StagedFolder::create(to);
  if (!staged) return tl::unexpected(staged.error());
  std::error_code error;
  fs::copy(from, staged->path(), fs::copy_options::recursive, error);
  if (error) {
    return fail(ErrorCode::io,
                fmt::format("{}: cannot be copied to {}: {}", from.string(), to.string(), error.message()));
  }
  return staged->commit();
}

}  // namespace

Result<std::vector<ListedRun>> list_runs(const fs::path& root) {
  const auto files = record_files(root);
  if (!files) return tl::unexpected(files.error());
  const RecordHead unreadable{RunStatus::failed, "its record cannot be read", ""};
  std::vector<ListedRun> runs;
  for (const fs::path& file : *files) {
    const fs::path folder = file.parent_path();
    const auto head = record_head(folder);
    runs.push_back({folder.lexically_relative(root), head.value_or(unreadable), head.has_value()});
  }
  std::ranges::sort(runs, {}, &ListedRun::folder);
  return runs;
}

Result<GarbageReport> collect_garbage(const fs::path& root, const Garbage& garbage) {
  const auto runs = list_runs(root);
  if (!runs) return tl::unexpected(runs.error());
  GarbageReport report;
  std::set<fs::path> parents;
  for (const ListedRun& run : *runs) {
    const fs::path folder = root / run.folder;
    parents.insert(folder.parent_path());
    if (!run.readable || !is_garbage(folder, run.head, garbage)) continue;  // what it is, nobody knows
    ++report.runs;
    report.bytes += size_of(folder);
    const auto error = garbage.only_look ? std::error_code() : remove_whole(folder);
    if (error)
      return fail(ErrorCode::io, fmt::format("{}: cannot be removed: {}", folder.string(), error.message()));
  }
  report.temporaries += remove_free_claims(root, garbage.only_look);
  std::error_code error;
  for (fs::recursive_directory_iterator entry(root, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_directory(ignored)) continue;
    if (entry->path().filename().string().starts_with('.')) {
      parents.insert(entry->path().parent_path());
      entry.disable_recursion_pending();
    }
  }
  for (const fs::path& parent : parents) {
    report.temporaries += remove_abandoned(parent, garbage.only_look);
  }
  return report;
}

Result<MergeReport> merge_runs(const fs::path& from, const fs::path& into) {
  const auto runs = list_runs(from);
  if (!runs) return tl::unexpected(runs.error());
  MergeReport report;
  for (const ListedRun& run : *runs) {
    const fs::path target = into / run.folder;
    const auto there = record_head(target);
    std::error_code ignored;
    const bool same = there && there->run_id == run.head.run_id;
    const bool finished_there = same && there->status != RunStatus::failed;
    if (finished_there || (same && run.head.status == RunStatus::failed)) {
      ++report.there;
      if (finished_there && run.head.status != RunStatus::failed && there->status != run.head.status)
        ++report.differing;
      continue;
    }
    const bool taken = !same && fs::exists(target, ignored);
    const fs::path free_place = taken ? longer_place(target, run.head.run_id) : target;
    if (auto copied = copy_run(from / run.folder, free_place); !copied) return tl::unexpected(copied.error());
    ++report.copied;
  }
  copy_invocations(from, into);
  return report;
}

}  // namespace fusebench
