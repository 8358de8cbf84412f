#include "eval/text/text_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/io/staged_file.hpp"
#include "core/io/whole_file.hpp"

namespace fusebench::text {

namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& file, const std::error_code& reason) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", file.string(), reason.message()),
              reason == std::errc::no_space_on_device ? "make room there, or choose another place"
                                                      : "choose a file in a folder that can be written");
}

}  // namespace

Result<void> write_text_file(const std::filesystem::path& file, std::string_view text) {
  namespace fs = std::filesystem;
  std::error_code error;
  // What is there and no plain file (a device, a pipe) is written to; a link is followed.
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    if (const std::error_code reason = io::write_whole_file(file, text)) return cannot_write(file, reason);
    return {};
  }
  if (fs::is_symlink(file, error)) return write_text_file(fs::canonical(file, error), text);
  error.clear();
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error) return cannot_write(file, error);
  if (const std::error_code reason = io::write_file_atomically(file, text)) return cannot_write(file, reason);
  return {};
}

}  // namespace fusebench::text
