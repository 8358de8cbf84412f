#include "eval/record/run_files/found_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/base/io/staged_folder.hpp"
#include "core/config/variants.hpp"
#include "eval/record/run_files/option_order.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::run_files {

namespace fs = std::filesystem;

std::size_t variant_rank(const std::string& name) {
  const auto variants = config::all_variants();
  const auto found = std::find_if(variants.begin(), variants.end(),
                                  [&](const config::Variant& v) { return v.name == name; });
  return static_cast<std::size_t>(found - variants.begin());
}

namespace {

/// The record of a run that is not whole.
record::RunRecord failed_record(const fs::path& folder, std::string reason) {
  const PlaceOfRun place = place_of_run(folder);
  record::RunRecord record;
  record.reason = std::move(reason);
  record.recording.name = place.recording;
  record.recording.data = record::kUnknownWord;
  record.recording.imu = record::kUnknownWord;
  record.recording.truth = record::kUnknownWord;
  record.variant = place.variant;
  return record;
}

/// The numbers of a run whose files are damaged are not to be trusted; what was asked of it is known.
void forget_results(record::RunRecord& record, std::string reason) {
  record.status = record::RunStatus::failed;
  record.reason = std::move(reason);
  record.metrics = {};
  record.frames = {record.frames.total, 0, 0};
  record.model = {};
  record.timing = {};
}

bool is_within(const fs::path& folder, const fs::path& outer) {
  return std::mismatch(outer.begin(), outer.end(), folder.begin(), folder.end()).first == outer.end();
}

fs::path real_path(const fs::path& path) {
  std::error_code ignored;
  return fs::canonical(path, ignored);
}

/// Folders that links lead to: none is looked through again within itself, nor one that holds where it began.
class LinkedFolders {
 public:
  explicit LinkedFolders(const fs::path& root) : taken_{real_path(root)} {}

  bool take(const fs::path& link) {
    const fs::path folder = real_path(link);
    const bool circle =
        folder.empty() || is_within(taken_.front(), folder) ||
        std::ranges::any_of(taken_, [&](const fs::path& taken) { return is_within(folder, taken); });
    if (!circle) taken_.push_back(folder);
    return !circle;
  }
  [[nodiscard]] bool any() const { return taken_.size() > 1; }

 private:
  std::vector<fs::path> taken_;  ///< the root first
};

/// Each file once, by the first of its names.
void leave_each_once(std::vector<fs::path>& files) {
  std::ranges::sort(files);
  std::set<fs::path> met;
  std::erase_if(files, [&](const fs::path& file) { return !met.insert(real_path(file)).second; });
}

}  // namespace

bool is_engine_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.filename() != kEngineFolderName || !fs::is_directory(folder, error)) return false;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename();
    if (name != "claims" && name != "invocations" && name != "slurm") return false;
  }
  return !error;
}

PlaceOfRun place_of_run(const fs::path& folder) {
  std::error_code ignored;
  const fs::path run = fs::absolute(folder, ignored).lexically_normal();
  const fs::path variant = (run.has_filename() ? run : run.parent_path()).parent_path();
  return {variant.parent_path().filename().string(), variant.filename().string()};
}

std::optional<FoundRun> found_run(const fs::path& folder) {
  const fs::path file = folder / "record.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  auto record = record::read_record(file);
  if (!record) {
    const Error& error = record.error();
    const bool damaged = error.code == ErrorCode::data_corrupt;
    // The message begins with the file, which the row names already.
    const std::string problem = error.message.substr(file.string().size() + 2);
    return FoundRun{
        folder,
        failed_record(folder, damaged ? damage_text("record.json", problem) : "record.json: " + problem),
        damaged ? RunState::damaged : RunState::unreadable};
  }
  if (std::string text = changed_size(folder, *record); !text.empty()) {
    forget_results(*record, std::move(text));
    return FoundRun{folder, std::move(*record), RunState::damaged};
  }
  return FoundRun{folder, std::move(*record)};
}

Result<std::vector<fs::path>> record_files(const fs::path& runs) {
  std::error_code error;
  std::vector<fs::path> files;
  LinkedFolders linked(runs);
  fs::recursive_directory_iterator entry(runs, fs::directory_options::follow_directory_symlink, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      const bool again = entry->is_symlink(ignored) && !linked.take(entry->path());
      if (again || io::is_staged_folder(entry->path()) || is_engine_folder(entry->path()))
        entry.disable_recursion_pending();
    } else if (entry->path().filename() == "record.json") {
      files.push_back(entry->path());
    }
  }
  if (linked.any()) leave_each_once(files);
  if (!error) return files;
  std::error_code ignored;
  if (!fs::is_directory(runs, ignored)) {
    return fail(
        ErrorCode::data_missing,
        fmt::format("{}: {}", runs.string(), fs::exists(runs, ignored) ? "no folder" : "no such folder"),
        "the folder of a run, or one that holds some (--out of `fusebench run` and `fusebench bench`)");
  }
  return fail(ErrorCode::data_missing,
              fmt::format("{}: cannot be listed: {}", runs.string(), error.message()));
}

tl::unexpected<Error> holds_no_runs(const fs::path& runs) {
  return fail(ErrorCode::data_missing, fmt::format("{}: holds no runs", runs.string()),
              "`fusebench run` and `fusebench bench` write them to their --out");
}

namespace {

/// By recording, variant, options by value, folder.
void sort_runs(std::vector<FoundRun>& runs) {
  std::vector<std::pair<RunOptions, FoundRun>> keyed;
  for (FoundRun& run : runs) {
    RunOptions options = identity_of(run).options;
    keyed.emplace_back(std::move(options), std::move(run));
  }
  std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) {
    const auto key = [](const FoundRun& run) {
      const std::string& fingerprint = run.record.recording.fingerprint;
      // An unreadable record has none: after those of its name.
      return std::tuple(run.record.recording.name, fingerprint.empty(), fingerprint,
                        variant_rank(run.record.variant), run.record.variant);
    };
    const auto key_a = key(a.second);
    const auto key_b = key(b.second);
    if (key_a != key_b) return key_a < key_b;
    if (a.first != b.first) return RunOptionsLess()(a.first, b.first);
    return a.second.folder.string() < b.second.folder.string();
  });
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i] = std::move(keyed[i].second);
}

}  // namespace

Result<std::vector<FoundRun>> find_runs(const fs::path& runs) {
  const auto files = record_files(runs);
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) return holds_no_runs(runs);
  std::vector<FoundRun> found;
  for (const fs::path& file : *files) {
    // One that was removed just now is none.
    if (auto run = found_run(file.parent_path())) found.push_back(std::move(*run));
  }
  sort_runs(found);
  return found;
}

}  // namespace fusebench::run_files
