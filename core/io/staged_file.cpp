#include "core/io/staged_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "core/io/abandoned.hpp"
#include "core/io/temporary_name.hpp"
#include "core/io/whole_file.hpp"

namespace fusebench::io {

namespace fs = std::filesystem;

namespace {

/// An empty file beside the place that no other process has, and its lock (-1: the file system has none).
struct NewFile {
  fs::path path;
  int lock = -1;
};

std::error_code create_hidden(const fs::path& file, NewFile& created) {
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    const fs::path path = hidden_sibling(file, attempt);
    const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return {errno, std::generic_category()};
    close(descriptor);
    created = {path, lock_place(path)};
    return {};
  }
  return std::make_error_code(std::errc::file_exists);
}

}  // namespace

std::error_code write_file_atomically(const fs::path& file, std::string_view text) {
  remove_abandoned_of(file);
  NewFile hidden;
  if (const std::error_code error = create_hidden(file, hidden)) return error;
  std::error_code error = write_whole_file(hidden.path, text);
  if (!error) fs::rename(hidden.path, file, error);
  std::error_code ignored;
  if (error) fs::remove(hidden.path, ignored);
  if (hidden.lock >= 0) close(hidden.lock);
  return error;
}

bool is_staged_file(const fs::path& file) {
  std::error_code error;
  return name_of_hidden_sibling(file.filename().string()).has_value() &&
         fs::is_regular_file(fs::symlink_status(file, error));
}

}  // namespace fusebench::io
