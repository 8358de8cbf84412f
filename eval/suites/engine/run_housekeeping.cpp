#include "eval/suites/engine/run_housekeeping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "core/base/io/abandoned.hpp"
#include "core/base/io/staged_file.hpp"
#include "core/base/io/staged_folder.hpp"
#include "eval/record/build_info.hpp"
#include "eval/record/record.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/suites/engine/invocation.hpp"
#include "eval/suites/engine/run_claim.hpp"

namespace fusebench::engine {

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

/// As place_run() and record_not_started() call the folders of runs: what else is called record.json may be
/// somebody else's.
bool has_name_of_run(const fs::path& folder) {
  constexpr std::size_t kFewestDigits = 8;
  const std::string name = folder.filename().string();
  const std::size_t digits = std::min(name.find_first_not_of("0123456789abcdef"), name.size());
  return name.starts_with("not-started-") ||
         (digits >= kFewestDigits && (digits == name.size() || name.compare(digits, 2, "-r") == 0));
}

bool is_garbage(const fs::path& folder, const run::RecordHead& head, const Garbage& garbage) {
  if (head.state == run_files::RunState::unreadable) return false;  // unknown content
  if (head.state == run_files::RunState::damaged) return garbage.failed && has_name_of_run(folder);
  if (garbage.failed && head.status == record::RunStatus::failed) return true;
  if (!garbage.stale) return false;
  const auto record = record::read_record(folder / "record.json");
  // Imported runs come from elsewhere, and have no estimator of ours.
  return record && !record->config.empty() && record->provenance.estimator != record::build_info().estimator;
}

/// Where place_run() looks next for an identity whose first digits are another's there.
fs::path longer_place(const fs::path& target, const std::string& run_id) {
  constexpr std::size_t kDigits = 16;
  const std::string name = target.filename().string();
  const std::size_t repetition = name.find("-r");
  return target.parent_path() /
         (run_id.substr(0, kDigits) + (repetition == std::string::npos ? "" : name.substr(repetition)));
}

/// A link would bring in what is elsewhere, and a pipe or device never ends: no run has them.
bool holds_plain_files_only(const fs::path& folder) {
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::file_status status = entry->symlink_status(error);
    if (!fs::is_regular_file(status) && !fs::is_directory(status)) return false;
  }
  return !error;
}

Result<void> copy_run(const fs::path& from, const fs::path& to) {
  auto staged = io::StagedFolder::create(to);
  if (!staged) return tl::unexpected(staged.error());
  std::error_code error;
  fs::copy(from, staged->path(), fs::copy_options::recursive, error);
  if (error) {
    return fail(ErrorCode::io,
                fmt::format("{}: cannot be copied to {}: {}", from.string(), to.string(), error.message()));
  }
  return staged->commit();
}

/// A file that is not what the run wrote makes it a damaged one.
void verify_files(const fs::path& folder, run::RecordHead& head) {
  if (head.state != run_files::RunState::whole) return;
  const auto record = record::read_record(folder / "record.json");
  const auto checked = record ? run_files::check_files(folder, *record) : Result<void>();
  if (checked) return;
  head.status = record::RunStatus::failed;
  head.state = run_files::RunState::damaged;
  head.reason = checked.error().message;
}

tl::unexpected<Error> cannot_be_removed(const fs::path& path, const std::error_code& error) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be removed: {}", path.string(), error.message()),
              "everything before it is removed; gc goes on from there once it may write to its folder");
}

/// The folders in which there is something under a temporary name, and that of kept invocations.
std::set<fs::path> parents_of_temporaries(const fs::path& root) {
  std::set<fs::path> parents = {invocations_folder(root)};
  std::error_code error;
  for (fs::recursive_directory_iterator entry(root, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (io::is_staged_file(entry->path())) parents.insert(entry->path().parent_path());
    if (!entry->is_directory(ignored)) continue;
    const bool is_staged = io::is_staged_folder(entry->path());
    if (is_staged) parents.insert(entry->path().parent_path());
    if (is_staged || run_files::is_engine_folder(entry->path())) entry.disable_recursion_pending();
  }
  return parents;
}

}  // namespace

Result<std::vector<ListedRun>> list_runs(const fs::path& root, bool verify) {
  const auto files = run_files::record_files(root);
  if (!files) return tl::unexpected(files.error());
  std::vector<ListedRun> runs;
  for (const fs::path& file : *files) {
    const fs::path folder = file.parent_path();
    const auto run = run_files::found_run(folder);
    if (!run) continue;  // removed just now
    run::RecordHead head = run::head_of(*run);
    if (verify) verify_files(folder, head);
    runs.push_back({folder.lexically_relative(root), std::move(head), run_files::identity_of(*run)});
  }
  std::ranges::sort(runs, {}, &ListedRun::folder);
  return runs;
}

Result<GarbageReport> collect_garbage(const fs::path& root, const Garbage& garbage) {
  const auto runs = list_runs(root);
  if (!runs) return tl::unexpected(runs.error());
  if (runs->empty() && !run_files::is_engine_folder(engine_folder(root)))
    return run_files::holds_no_runs(root);
  GarbageReport report;
  for (const ListedRun& run : *runs) {
    const fs::path folder = root / run.folder;
    if (!is_garbage(folder, run.head, garbage)) continue;
    ++report.runs;
    report.bytes += size_of(folder);
    report.paths.push_back(folder);
    const auto error = garbage.only_look ? std::error_code() : io::remove_atomically(folder);
    if (error) return cannot_be_removed(folder, error);
  }
  const auto add_temporaries = [&](const std::vector<fs::path>& paths) {
    report.temporaries += paths.size();
    report.paths.insert(report.paths.end(), paths.begin(), paths.end());
  };
  add_temporaries(remove_free_claims(root, garbage.only_look));
  for (const fs::path& parent : parents_of_temporaries(root)) {
    const io::Abandoned abandoned = io::remove_abandoned(parent, garbage.only_look);
    if (!abandoned.kept.empty())
      return cannot_be_removed(abandoned.kept.front().path, abandoned.kept.front().reason);
    add_temporaries(abandoned.removed);
  }
  std::ranges::sort(report.paths);
  return report;
}

Result<MergeReport> merge_runs(const fs::path& from, const fs::path& into) {
  const auto runs = list_runs(from);
  if (!runs) return tl::unexpected(runs.error());
  MergeReport report;
  for (const ListedRun& run : *runs) {
    if (run.head.state != run_files::RunState::whole || !holds_plain_files_only(from / run.folder)) {
      ++report.damaged;
      continue;
    }
    const fs::path target = into / run.folder;
    const auto there = run::record_head(target);
    std::error_code ignored;
    const bool replaced = there && there->state == run_files::RunState::damaged;
    const bool same = there && !replaced && there->run_id == run.head.run_id;
    const bool finished_there = same && there->status != record::RunStatus::failed;
    if (finished_there || (same && run.head.status == record::RunStatus::failed)) {
      ++report.there;
      if (finished_there && run.head.status != record::RunStatus::failed && there->status != run.head.status)
        ++report.differing;
      continue;
    }
    const bool taken = !same && !replaced && fs::exists(target, ignored);
    const fs::path free_place = taken ? longer_place(target, run.head.run_id) : target;
    if (auto copied = copy_run(from / run.folder, free_place); !copied) return tl::unexpected(copied.error());
    ++report.copied;
  }
  report.damaged_invocations = copy_invocations(from, into);
  return report;
}

}  // namespace fusebench::engine
