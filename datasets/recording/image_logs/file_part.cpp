#include "datasets/recording/image_logs/file_part.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "core/base/io/input_file.hpp"

namespace fusebench::image_logs {

Result<std::string> bytes_of_file(const std::filesystem::path& file, std::uint64_t position,
                                  std::uint64_t count) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream = io::input_file(file);
  if (error || !stream)
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read as a file", file.string()));
  const bool inside = position <= size && count <= size - position;
  std::string bytes(inside ? count : 0, '\0');
  stream.seekg(static_cast<std::streamoff>(position));
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!inside || !stream)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: byte {}: ends before {} bytes of an image", file.string(), position, count));
  return bytes;
}

}  // namespace fusebench::image_logs
