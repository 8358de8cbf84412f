#include "core/base/io/abandoned.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <optional>
#include <string>
#include <system_error>

#include "core/base/io/staged_file.hpp"
#include "core/base/io/staged_folder.hpp"
#include "core/base/io/temporary_name.hpp"

namespace fusebench::io {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::hours kFileAge{1};
constexpr std::chrono::hours kFolderAge{24};  // also of files where there are no locks

struct Leftover {
  fs::path path;
  std::chrono::hours age{};  ///< for which it must have been unchanged if nobody holds its lock
};

/// The temporary folders and files in `parent`, of this name or, without one, of all.
std::vector<Leftover> leftovers_in(const fs::path& parent, std::chrono::hours folder_age,
                                   const std::optional<std::string>& name = std::nullopt) {
  std::vector<Leftover> hidden;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    if (name && name_of_hidden_sibling(entry->path().filename().string()) != name) continue;
    if (is_staged_folder(entry->path())) hidden.push_back({entry->path(), folder_age});
    if (is_staged_file(entry->path())) hidden.push_back({entry->path(), kFileAge});
  }
  return hidden;
}

/// Whether the path still leads to what was opened: its owner may have renamed it, and another have taken the
/// name.
bool is_still_there(int descriptor, const fs::path& path) {
  struct stat opened {};
  struct stat there {};
  return fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &there) == 0 &&
         opened.st_ino == there.st_ino && opened.st_dev == there.st_dev;
}

/// Removes it if it is abandoned, unless it shall only look.
void remove_if_abandoned(const Leftover& leftover, bool only_look, Abandoned& found) {
  if (leftover.age.count() > 0 && !is_unchanged_for(leftover.path, leftover.age)) return;
  const int lock = lock_place(leftover.path);
  const bool unlockable = lock < 0 && errno != EWOULDBLOCK && errno != ENOENT;
  const bool abandoned = lock >= 0 ? is_still_there(lock, leftover.path)
                                   : unlockable && is_unchanged_for(leftover.path, kFolderAge);
  std::error_code error;
  // The lock is held meanwhile, so that a process that has just created the folder notices.
  if (abandoned && !only_look) fs::remove_all(leftover.path, error);
  if (lock >= 0) close(lock);
  if (error) found.kept.push_back({leftover.path, error});
  if (abandoned && !error) found.removed.push_back(leftover.path);
}

}  // namespace

Abandoned remove_abandoned(const fs::path& parent, bool only_look) {
  Abandoned found;
  for (const Leftover& leftover : leftovers_in(parent, std::chrono::hours(0)))
    remove_if_abandoned(leftover, only_look, found);
  return found;
}

void remove_abandoned_of(const fs::path& place) {
  const fs::path parent = place.has_parent_path() ? place.parent_path() : fs::path(".");
  Abandoned ignored;  // what stays is no obstacle: a name that is taken is not used
  for (const Leftover& leftover : leftovers_in(parent, kFolderAge, place.filename().string()))
    remove_if_abandoned(leftover, false, ignored);
}

void remove_abandoned_of(const fs::path& place, pid_t ended_process) {
  Abandoned ignored;
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    const fs::path hidden = hidden_sibling(place, attempt, ended_process);
    if (!is_staged_folder(hidden) && !is_staged_file(hidden)) return;  // a later name was not needed
    remove_if_abandoned({hidden}, false, ignored);
  }
}

}  // namespace fusebench::io
