#include "eval/text/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

namespace fusebench::text {

namespace {

Result<void> write_through(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (stream) return {};
  return fail(ErrorCode::io, fmt::format("{}: cannot be written", file.string()),
              "choose a file in a folder that can be written");
}

}  // namespace

Result<void> write_text_file(const std::filesystem::path& file, std::string_view text) {
  namespace fs = std::filesystem;
  std::error_code error;
  // What is there and no plain file (a device, a pipe) is written to; a link is followed.
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) return write_through(file, text);
  if (fs::is_symlink(file, error)) return write_text_file(fs::canonical(file, error), text);
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  // Other processes may write the same file at the same time: the last one stays.
  const fs::path temporary =
      file.parent_path() / fmt::format(".{}.{}.tmp", file.filename().string(), getpid());
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (stream) fs::rename(temporary, file, error);
  if (stream && !error) return {};
  fs::remove(temporary, error);
  return fail(ErrorCode::io, fmt::format("{}: cannot be written", file.string()),
              "choose a file in a folder that can be written");
}

}  // namespace fusebench::text
