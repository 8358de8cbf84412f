#include "eval/found_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/variants.hpp"

namespace fusebench {

namespace fs = std::filesystem;

std::size_t variant_rank(const std::string& name) {
  const auto variants = all_variants();
  const auto found =
      std::find_if(variants.begin(), variants.end(), [&](const Variant& v) { return v.name == name; });
  return static_cast<std::size_t>(found - variants.begin());
}

Result<std::vector<fs::path>> record_files(const fs::path& runs) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::recursive_directory_iterator entry(runs, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with('.') && entry->is_directory()) {
      entry.disable_recursion_pending();
    } else if (name == "record.json") {
      files.push_back(entry->path());
    }
  }
  if (!error) return files;
  return fail(ErrorCode::data_missing,
              fmt::format("{}: cannot be listed: {}", runs.string(), error.message()));
}

tl::unexpected<Error> holds_no_runs(const fs::path& runs) {
  return fail(ErrorCode::data_missing, fmt::format("{}: holds no runs", runs.string()),
              "`fusebench run` and `fusebench bench` write them to their --out");
}

Result<std::vector<FoundRun>> find_runs(const fs::path& runs) {
  const auto files = record_files(runs);
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) return holds_no_runs(runs);
  std::vector<FoundRun> found;
  for (const fs::path& file : *files) {
    auto record = read_record(file);
    if (!record) return tl::unexpected(record.error());
    found.push_back({file.parent_path(), std::move(*record)});
  }
  std::sort(found.begin(), found.end(), [](const FoundRun& a, const FoundRun& b) {
    const auto key = [](const FoundRun& run) {
      return std::tuple(run.record.recording.name, run.record.recording.fingerprint,
                        variant_rank(run.record.variant), run.record.variant, run.folder.string());
    };
    return key(a) < key(b);
  });
  return found;
}

}  // namespace fusebench
