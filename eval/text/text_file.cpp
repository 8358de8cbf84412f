#include "eval/text/text_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/base/io/staged_file.hpp"

namespace fusebench::text {

namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& file, const std::error_code& reason) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", file.string(), reason.message()),
              reason == std::errc::no_space_on_device ? "make room there, or choose another place"
                                                      : "choose a file in a folder that can be written");
}

}  // namespace

Result<void> write_text_file(const std::filesystem::path& file, std::string_view text) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (error) return cannot_write(file, error);
  if (const std::error_code reason = io::write_file_atomically(file, text)) return cannot_write(file, reason);
  return {};
}

}  // namespace fusebench::text
