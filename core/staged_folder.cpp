#include "core/staged_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <system_error>
#include <utility>

namespace fusebench {

namespace fs = std::filesystem;

namespace {

// Others work beside us only now and then, so that a few attempts in a row do not all meet them.
constexpr int kAttempts = 100;

/// ".<name>.<process>[-<attempt>].tmp" beside a path; the dot keeps it out of listings. Processes of other
/// machines can have the same number.
fs::path hidden_sibling(const fs::path& path, int attempt) {
  const std::string again = attempt == 0 ? "" : fmt::format("-{}", attempt);
  return path.parent_path() / fmt::format(".{}.{}{}.tmp", path.filename().string(), getpid(), again);
}

tl::unexpected<Error> io_error(const fs::path& path, const std::error_code& error) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", path.string(), error.message()),
              "choose another folder with --out");
}

/// The folders above a path that are not there; those that it made are added, outermost first.
std::error_code create_parents(const fs::path& path, std::vector<fs::path>& created) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path parent = path.parent_path(); !parent.empty() && !fs::exists(parent, error);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  error.clear();
  for (auto parent = missing.rbegin(); parent != missing.rend() && !error; ++parent) {
    // Another process may have made it in the meantime: that is not an error, and it is not ours to remove.
    if (fs::create_directory(*parent, error)) created.push_back(*parent);
  }
  return error;
}

/// Tells others that somebody works in the folder; the system lets go of it when the process ends, however it
/// does. -1 where the file system has no locks, and where somebody else has this one.
int lock_folder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int why = errno;
  if (descriptor >= 0) close(descriptor);
  errno = why;
  return -1;
}

bool is_older_than_a_day(const fs::path& folder) {
  std::error_code error;
  const auto written = fs::last_write_time(folder, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
}

}  // namespace

Result<StagedFolder> StagedFolder::create(const fs::path& final_folder) {
  StagedFolder folder;
  folder.final_ = final_folder.has_filename() ? final_folder : final_folder.parent_path();  // "folder/"
  std::error_code error;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const fs::path temporary = hidden_sibling(folder.final_, attempt);
    error = create_parents(folder.final_, folder.created_);
    if (!error && fs::create_directory(temporary, error)) {
      folder.temporary_ = temporary;
      folder.lock_ = lock_folder(temporary);
      // Somebody took the empty folder for one that was left by a dead process, and is removing it.
      if (folder.lock_ < 0 && errno == EWOULDBLOCK) continue;
      if (fs::create_directory(folder.path(), error)) return folder;
    }
    // Others may have removed a parent that was theirs, or the folder of this name, just now.
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
      created_(std::exchange(other.created_, {})) {}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  if (lock_ >= 0) close(lock_);
  // Innermost first; one that holds something else stays.
  for (auto parent = created_.rbegin(); parent != created_.rend(); ++parent) fs::remove(*parent, ignored);
}

Result<void> StagedFolder::write(std::string_view name, std::string_view text) const {
  std::ofstream stream(file(name), std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) return fail(ErrorCode::io, fmt::format("{}: cannot be written", file(name).string()));
  return {};
}

Result<void> StagedFolder::commit() {
  const fs::path old = temporary_ / "old";
  std::error_code error;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    fs::rename(final_, old, error);
    if (error && error != std::errc::no_such_file_or_directory) break;
    fs::rename(path(), final_, error);
    std::error_code ignored;
    if (!error) {
      fs::remove_all(std::exchange(temporary_, {}), ignored);
      created_.clear();
      return {};
    }
    // Another one was committed in between. It is replaced in its turn; what it replaced is out of date.
    const bool met_another = error == std::errc::directory_not_empty || error == std::errc::file_exists;
    if (!met_another) {
      fs::rename(old, final_, ignored);  // if there is one
      break;
    }
    fs::remove_all(old, ignored);
  }
  return io_error(final_, error);
}

std::size_t remove_abandoned(const fs::path& parent, bool only_count) {
  std::vector<fs::path> hidden;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (name.starts_with('.') && name.ends_with(".tmp") && entry->is_directory(ignored))
      hidden.push_back(entry->path());
  }
  std::size_t count = 0;
  for (const fs::path& folder : hidden) {
    const int lock = lock_folder(folder);
    const bool unlockable = lock < 0 && errno != EWOULDBLOCK && errno != ENOENT;
    std::error_code ignored;
    if (lock >= 0 || (unlockable && is_older_than_a_day(folder))) {
      ++count;
      // The lock is held meanwhile, so that whoever has just made the folder learns it.
      if (!only_count) fs::remove_all(folder, ignored);
    }
    if (lock >= 0) close(lock);
  }
  return count;
}

}  // namespace fusebench
