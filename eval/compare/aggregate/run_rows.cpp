#include "eval/compare/aggregate/run_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/base/io/bounded_text.hpp"
#include "eval/compare/aggregate/record_scan.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/option_order.hpp"
#include "eval/record/run_files/record_files.hpp"

namespace fusebench::aggregate {

namespace fs = std::filesystem;

namespace {

RunRow read_row(const fs::path& root, const fs::path& file) {
  RunRow row;
  const fs::path folder = file.parent_path();
  if (const auto text = io::whole_text(file, record::kMostRecordBytes, "record")) {
    std::vector<record::RecordedFile> files;
    row = scan_record(*text, &files);
    if (std::string damage = row.readable ? run_files::changed_size(folder, files) : ""; !damage.empty())
      row = damaged_row(std::move(row), std::move(damage));
  } else {
    row = row_without_record(std::move(row), "record.json: cannot be read");
  }
  if (!row.readable) {
    const run_files::PlaceOfRun place = run_files::place_of_run(folder);
    row.recording = place.recording;
    row.variant = place.variant;
  }
  row.run = folder.filename().string();
  row.folder = folder.lexically_relative(root).generic_string();
  return row;
}

/// A run that failed before it wrote its options is still known by the hash of its configuration.
void recover_options(std::vector<RunRow>& rows) {
  std::map<std::tuple<std::string, std::string>, const RunOptions*> known;
  bool any_edited = false;
  for (const RunRow& row : rows) {
    any_edited = any_edited || !row.options.empty();
    if (!row.attributable() || row.config_hash.empty()) continue;
    const auto [at, is_new] = known.try_emplace({row.variant, row.config_hash}, &row.options);
    // Several option lists may come to the same values; which is taken must not depend on names of folders.
    if (!is_new && run_files::RunOptionsLess()(row.options, *at->second)) at->second = &row.options;
  }
  for (RunRow& row : rows) {
    if (!row.readable || row.options_known) continue;
    const auto found = known.find({row.variant, row.config_hash});
    if (found != known.end()) row.options = *found->second;
    row.options_known = found != known.end() || !any_edited;
  }
}

void sort_rows(std::vector<RunRow>& rows) {
  std::map<std::string, std::size_t> ranks;
  for (const RunRow& row : rows) ranks.try_emplace(row.variant, run_files::variant_rank(row.variant));
  std::ranges::sort(rows, [&](const RunRow& a, const RunRow& b) {
    if (a.recording != b.recording) return a.recording < b.recording;
    if (a.variant != b.variant)
      return std::tuple(ranks.at(a.variant), a.variant) < std::tuple(ranks.at(b.variant), b.variant);
    if (a.options != b.options) return run_files::RunOptionsLess()(a.options, b.options);
    return std::tie(a.run, a.folder) < std::tie(b.run, b.folder);
  });
}

}  // namespace

std::string_view option_of(const RunRow& row, std::string_view key) {
  for (const auto& [name, value] : row.options) {
    if (name == key) return value;
  }
  return kUnsetOption;
}

std::vector<std::string> edited_options(std::span<const RunRow> rows) {
  std::set<std::string> keys;
  for (const RunRow& row : rows) {
    for (const auto& option : row.options) keys.insert(option.first);
  }
  return {keys.begin(), keys.end()};
}

std::size_t unreadable_count(std::span<const RunRow> rows) {
  return static_cast<std::size_t>(
      std::ranges::count_if(rows, [](const RunRow& row) { return !row.readable; }));
}

Result<std::vector<RunRow>> read_run_rows(const fs::path& root, const Workers& workers) {
  constexpr std::size_t kRecordsPerChunk = 32;
  const auto files = run_files::record_files(root);
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) return run_files::holds_no_runs(root);
  auto chunks = workers.map_chunks<std::vector<RunRow>>(files->size(), kRecordsPerChunk,
                                                        [&](std::size_t begin, std::size_t end) {
                                                          std::vector<RunRow> rows;
                                                          for (std::size_t i = begin; i < end; ++i)
                                                            rows.push_back(read_row(root, (*files)[i]));
                                                          return rows;
                                                        });
  std::vector<RunRow> rows;
  rows.reserve(files->size());
  for (std::vector<RunRow>& chunk : chunks) std::ranges::move(chunk, std::back_inserter(rows));
  recover_options(rows);
  sort_rows(rows);
  set_labels(rows);
  return rows;
}

}  // namespace fusebench::aggregate
