#include "core/base/io/staged_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/base/io/abandoned.hpp"
#include "core/base/io/temporary_name.hpp"
#include "core/base/io/whole_file.hpp"

namespace fusebench::io {

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> io_error(const fs::path& path, const std::error_code& error) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", path.string(), error.message()),
              "choose another folder with --out");
}

/// The folders above a path that are not there; those that were created are added, outermost first.
std::error_code create_parents(const fs::path& path, std::vector<fs::path>& created) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path parent = path.parent_path(); !parent.empty() && !fs::exists(parent, error);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  error.clear();
  for (auto parent = missing.rbegin(); parent != missing.rend() && !error; ++parent) {
    created.push_back(*parent);  // first: what is created has to be removed, also when memory runs out
    // Another process may have created it in the meantime: no error, and it must not be removed here.
    if (!fs::create_directory(*parent, error)) created.pop_back();
  }
  return error;
}

/// All of the file system that holds a folder: what a folder of a thousand images takes 50 times longer for
/// file by file.
std::error_code sync_file_system(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {errno, std::generic_category()};
  const int failed = syncfs(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  return {failed, std::generic_category()};
}

/// Every file and folder below, and then the folder itself.
std::error_code sync_tree(const fs::path& folder) {
  constexpr std::ptrdiff_t kManyFiles = 50;  // a run has ten, a recording hundreds
  std::error_code error;
  std::ptrdiff_t count = 0;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    ++count;
  if (error) return error;
  if (count > kManyFiles) return sync_file_system(folder);
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_symlink(error) || error) continue;
    const bool is_kept = entry->is_regular_file(error) || entry->is_directory(error);
    if (is_kept && !error) error = sync_to_disk(entry->path());
    if (error) return error;
  }
  return error ? error : sync_to_disk(folder);
}

/// A folder of this program's with all in it; once more if something was in the way for a moment (descriptors
/// of other threads).
void remove_folder(const fs::path& folder) {
  std::error_code error;
  for (int attempt = 0; attempt < 2; ++attempt) {
    fs::remove_all(folder, error);
    if (!error) return;
  }
}

/// The parent folder of a path.
fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

std::error_code sync_to_disk(const fs::path& place) {
  const int descriptor = open(place.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {errno, std::generic_category()};
  const int failed = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  if (failed == EINVAL || failed == ENOTSUP) return {};
  return {failed, std::generic_category()};
}

Result<StagedFolder> StagedFolder::create(const fs::path& final_folder) {
  StagedFolder folder;
  folder.final_ = final_folder.has_filename() ? final_folder : final_folder.parent_path();  // "folder/"
  remove_abandoned_of(folder.final_);
  std::error_code error;
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    const fs::path temporary = hidden_sibling(folder.final_, attempt);
    error = create_parents(folder.final_, folder.created_);
    if (!error && fs::create_directory(temporary, error)) {
      folder.temporary_ = temporary;
      folder.lock_ = lock_place(temporary);
      // Another process regards the empty folder as abandoned and is removing it.
      if (folder.lock_ < 0 && errno == EWOULDBLOCK) continue;
      folder.mark_temporary();
      if (fs::create_directory(folder.path(), error)) return folder;
    }
    // Another process may just have removed a parent that it created, or the folder of this name.
    const bool met_another =
        !error || error == std::errc::no_such_file_or_directory || error == std::errc::file_exists;
    if (!met_another) break;
  }
  if (!error) error = std::make_error_code(std::errc::file_exists);
  return io_error(folder.final_, error);
}

StagedFolder::StagedFolder(StagedFolder&& other) noexcept
    : final_(std::move(other.final_)),
      temporary_(std::exchange(other.temporary_, {})),
      lock_(std::exchange(other.lock_, -1)),
      created_(std::exchange(other.created_, {})),
      marks_(std::exchange(other.marks_, {})) {}

void StagedFolder::mark_temporary() {
  marks_.clear();
  marks_.emplace_back(TemporaryMark::Kind::tree, temporary_);
  for (const fs::path& parent : created_) marks_.emplace_back(TemporaryMark::Kind::empty_folder, parent);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) remove_folder(temporary_);
  if (lock_ >= 0) close(lock_);
  // Innermost first; one that holds something else stays.
  for (auto parent = created_.rbegin(); parent != created_.rend(); ++parent) fs::remove(*parent, ignored);
}

Result<void> StagedFolder::write(std::string_view name, std::string_view text) const {
  if (const std::error_code error = write_whole_file(file(name), text)) return io_error(file(name), error);
  return {};
}

Result<void> StagedFolder::commit() {
  const fs::path old = temporary_ / "old";
  std::error_code error = sync_tree(path());
  if (error) return io_error(final_, error);
  marks_.clear();  // from here on the temporary folder may hold the only copy of the replaced one
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    fs::rename(final_, old, error);
    if (error && error != std::errc::no_such_file_or_directory) break;
    fs::rename(path(), final_, error);
    std::error_code ignored;
    if (!error) {
      // The replaced folder is removed once the new one is on the disk.
      error = sync_names(final_, created_);
      remove_folder(std::exchange(temporary_, {}));
      created_.clear();
      if (error) break;
      return {};
    }
    // Another one was committed in between. It is replaced as well.
    const bool met_another = error == std::errc::directory_not_empty || error == std::errc::file_exists;
    if (!met_another) {
      fs::rename(old, final_, ignored);  // if there is one
      break;
    }
    fs::remove_all(old, ignored);
  }
  return io_error(final_, error);
}

std::error_code sync_names(const fs::path& path, std::span<const fs::path> made) {
  fs::path folder = folder_of(path);
  std::error_code error = sync_to_disk(folder);
  // Those above may have been made just now, by another process or for something else, and not been synced.
  // What cannot be opened or synced there is not ours, unless it holds the name of a folder that is. Each is
  // synced once: a disk tells of a failure once only, and the second time nothing would be wrong.
  for (; !error && folder != folder_of(folder); folder = folder_of(folder)) {
    const std::error_code above = sync_to_disk(folder_of(folder));
    if (std::ranges::find(made, folder) != made.end()) error = above;
  }
  return error;
}

bool is_staged_folder(const fs::path& folder) {
  std::error_code error;
  if (!name_of_hidden_sibling(folder.filename().string()) || !fs::is_directory(folder, error)) return false;
  if (fs::is_symlink(folder, error)) return false;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename();
    std::error_code ignored;
    if ((name != "new" && name != "old") || !entry->is_directory(ignored)) return false;
  }
  return !error;
}

std::error_code remove_atomically(const fs::path& folder) {
  std::error_code error;
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    const fs::path hidden = hidden_sibling(folder, attempt);
    if (!fs::create_directory(hidden, error)) {
      if (error && error != std::errc::file_exists) return error;
      error = std::make_error_code(std::errc::file_exists);
      continue;
    }
    const int lock = lock_place(hidden);
    fs::rename(folder, hidden / "old", error);
    std::error_code removing;
    fs::remove_all(hidden, removing);
    if (lock >= 0) close(lock);
    return error ? error : removing;
  }
  return error;
}

}  // namespace fusebench::io
