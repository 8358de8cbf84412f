#include "core/base/io/temporary_name.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace fusebench::io {

namespace fs = std::filesystem;

namespace {

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

fs::path hidden_sibling(const fs::path& path, int attempt, pid_t process) {
  const std::string again = attempt == 0 ? "" : fmt::format("-{}", attempt);
  return path.parent_path() / fmt::format(".{}.{}{}.tmp", path.filename().string(), process, again);
}

std::optional<std::string> name_of_hidden_sibling(std::string_view name) {
  constexpr std::string_view kEnd = ".tmp";
  if (!name.starts_with('.') || !name.ends_with(kEnd) || name.size() <= kEnd.size()) return std::nullopt;
  name = name.substr(1, name.size() - 1 - kEnd.size());
  const std::size_t point = name.rfind('.');
  if (point == std::string_view::npos || point == 0) return std::nullopt;
  const std::string_view numbers = name.substr(point + 1);
  const std::size_t dash = numbers.find('-');
  if (!is_number(numbers.substr(0, dash))) return std::nullopt;
  if (dash != std::string_view::npos && !is_number(numbers.substr(dash + 1))) return std::nullopt;
  return std::string(name.substr(0, point));
}

int lock_place(const fs::path& place) {
  struct stat found {};
  if (lstat(place.c_str(), &found) != 0) return -1;
  if (!S_ISDIR(found.st_mode) && !S_ISREG(found.st_mode)) {
    errno = EINVAL;
    return -1;
  }
  // Over NFS a file is locked only if it is open for writing, and a folder not at all.
  const int access = S_ISDIR(found.st_mode) ? O_RDONLY | O_DIRECTORY : O_RDWR | O_NONBLOCK;
  const int descriptor = open(place.c_str(), access | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int why = errno;
  if (descriptor >= 0) close(descriptor);
  errno = why;
  return -1;
}

bool is_unchanged_for(const fs::path& place, std::chrono::hours age) {
  const auto now = fs::file_time_type::clock::now();
  std::error_code error;
  const auto is_old = [&](const fs::path& path) {
    struct stat found {};
    if (lstat(path.c_str(), &found) != 0) return false;
    const auto written = std::chrono::system_clock::from_time_t(found.st_mtim.tv_sec);
    return now - std::chrono::file_clock::from_sys(written) > age;
  };
  if (!is_old(place)) return false;
  if (!fs::is_directory(fs::symlink_status(place, error))) return !error;
  for (fs::recursive_directory_iterator entry(place, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_old(entry->path())) return false;
  }
  return !error;
}

}  // namespace fusebench::io
