#include "datasets/recording/exports/export_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/fingerprint.hpp"

namespace fusebench::exports {

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> exists_already(const fs::path& place) {
  return fail(ErrorCode::usage, fmt::format("{}: exists already, and nothing is replaced", place.string()),
              "remove it, or choose another place with --out");
}

bool have_same_bytes(const fs::path& one, const fs::path& other) {
  const auto first = io::Fingerprint().add_file(one);
  const auto second = io::Fingerprint().add_file(other);
  return first && second && *first == *second;
}

/// Files that were moved to their places, which are removed again unless all of them were.
class MovedFiles {
 public:
  explicit MovedFiles(std::size_t most) { files_.reserve(most); }
  MovedFiles(const MovedFiles&) = delete;
  MovedFiles& operator=(const MovedFiles&) = delete;
  ~MovedFiles() {
    std::error_code ignored;
    for (const fs::path& file : files_) fs::remove(file, ignored);
  }

  /// Error of the rename.
  [[nodiscard]] std::error_code move(const fs::path& from, const fs::path& to) {
    std::error_code error;
    files_.push_back(to);
    fs::rename(from, to, error);
    if (error) files_.pop_back();
    return error;
  }
  [[nodiscard]] bool empty() const { return files_.empty(); }
  void keep() { files_.clear(); }

 private:
  std::vector<fs::path> files_;
};

}  // namespace

tl::unexpected<Error> cannot_be_written(const fs::path& file, std::string_view reason) {
  return fail(ErrorCode::io,
              fmt::format("{}: cannot be written{}{}", file.string(), reason.empty() ? "" : ": ", reason),
              "choose another place with --out");
}

ExportPlace::ExportPlace(io::StagedFolder staged, fs::path out, Kind kind)
    : staged_(std::move(staged)), out_(std::move(out)), name_(out_.filename().string()), kind_(kind) {}

Result<ExportPlace> ExportPlace::create(const fs::path& out, Kind kind) {
  if (!out.has_filename() && (kind == Kind::files || out.empty()))
    return fail(ErrorCode::usage, fmt::format("out = '{}' is no name of a file", out.string()),
                "give the name of the file to write, e.g. --out room.klg");
  const fs::path place = out.has_filename() ? out : out.parent_path();  // "folder/"
  std::error_code error;
  if (fs::exists(fs::symlink_status(place, error))) return exists_already(place);
  auto staged = io::StagedFolder::create(place);
  if (!staged) return tl::unexpected(staged.error());
  return ExportPlace(std::move(*staged), place, kind);
}

std::string ExportPlace::beside(std::string_view ending) const {
  return fmt::format("{}.{}", fs::path(name_).stem().string(), ending);
}

Result<void> ExportPlace::create_folders(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    std::error_code error;
    fs::create_directories(file(name), error);
    if (error) return cannot_be_written(file(name), error.message());
  }
  return {};
}

Result<void> ExportPlace::write(const std::vector<TextFile>& files) const {
  for (const auto& [name, text] : files) {
    if (auto written = staged_.write(name, text); !written) return written;
  }
  return {};
}

Result<void> ExportPlace::commit() { return kind_ == Kind::folder ? staged_.commit() : move_files(); }

Result<void> ExportPlace::move_files() const {
  std::error_code error;
  std::vector<fs::path> names;
  for (fs::directory_iterator entry(staged_.path(), error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename());
  }
  if (error) return cannot_be_written(out_, error.message());
  // The file that was requested comes last: where it is, those beside it are as well, with the label of
  // simulated data among them.
  std::ranges::sort(names, {}, [&](const fs::path& name) { return std::pair(name == name_, name); });
  for (const fs::path& name : names) {
    const fs::path target = out_.parent_path() / name;
    const bool is_there = fs::exists(fs::symlink_status(target, error));
    // What an export that ended between two of its files has left is no obstacle.
    if (is_there && !have_same_bytes(staged_.path() / name, target)) return exists_already(target);
  }
  MovedFiles moved(names.size());
  for (const fs::path& name : names) {
    error = io::sync_to_disk(staged_.path() / name);
    // So are the names of those before it, on a disk that may lose what was not synced.
    if (!error && name == name_ && !moved.empty()) error = io::sync_names(out_);
    if (!error) error = moved.move(staged_.path() / name, out_.parent_path() / name);
    if (error) return cannot_be_written(out_, error.message());
  }
  // The names, which are the folder's.
  error = io::sync_names(out_);
  if (error) return cannot_be_written(out_, error.message());
  moved.keep();
  return {};
}

}  // namespace fusebench::exports
