#include "core/base/io/staged_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <iterator>
#include <utility>

#include "core/base/io/abandoned.hpp"
#include "core/base/io/temporary_name.hpp"
#include "core/base/io/whole_file.hpp"

namespace fusebench::io {

namespace fs = std::filesystem;

bool is_replaced_link(const fs::path& place) {
  std::error_code error;
  if (!fs::is_symlink(place, error) || fs::is_directory(place, error)) return false;
  const fs::path folder = fs::canonical(place.has_parent_path() ? place.parent_path() : ".", error);
  const auto top = folder.begin() == folder.end() ? folder.end() : std::next(folder.begin());
  return top == folder.end() || (*top != "dev" && *top != "proc");
}

tl::expected<StagedFile, std::error_code> StagedFile::create(const fs::path& place) {
  StagedFile file;
  file.place_ = place;
  file.path_ = place;
  std::error_code error;
  const fs::file_type is = fs::symlink_status(place, error).type();
  const bool has_plain_place = is == fs::file_type::regular || is == fs::file_type::not_found;
  if (!has_plain_place && !is_replaced_link(place)) return file;
  remove_abandoned_of(place);
  for (int attempt = 0; attempt < kNameAttempts; ++attempt) {
    const fs::path hidden = hidden_sibling(place, attempt);
    const int descriptor = open(hidden.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return tl::unexpected(std::error_code(errno, std::generic_category()));
    close(descriptor);
    file.mark_ = TemporaryMark(TemporaryMark::Kind::file, hidden);
    file.path_ = hidden;
    file.final_ = place;
    file.lock_ = lock_place(hidden);
    return file;
  }
  return tl::unexpected(std::make_error_code(std::errc::file_exists));
}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : place_(std::move(other.place_)),
      path_(std::move(other.path_)),
      final_(std::exchange(other.final_, {})),
      lock_(std::exchange(other.lock_, -1)),
      mark_(std::move(other.mark_)) {}

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!final_.empty()) fs::remove(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

std::error_code StagedFile::commit() {
  std::error_code error;
  if (final_.empty()) return error;
  fs::rename(path_, final_, error);
  if (!error) final_.clear();
  return error;
}

std::error_code write_file_atomically(const fs::path& file, std::string_view text) {
  auto staged = StagedFile::create(file);
  if (!staged) return staged.error();
  if (const std::error_code error = write_whole_file(staged->path(), text)) return error;
  return staged->commit();
}

bool is_staged_file(const fs::path& file) {
  std::error_code error;
  return name_of_hidden_sibling(file.filename().string()).has_value() &&
         fs::is_regular_file(fs::symlink_status(file, error));
}

}  // namespace fusebench::io
