#include "core/base/io/whole_file.hpp"

#include <cerrno>
#include <fstream>

namespace fusebench::io {

std::error_code write_whole_file(const std::filesystem::path& file, std::string_view text) {
  // Streams only say that something failed.
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  if (stream) stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream) stream.close();
  if (stream) return {};
  return {errno == 0 ? EIO : errno, std::generic_category()};
}

}  // namespace fusebench::io
