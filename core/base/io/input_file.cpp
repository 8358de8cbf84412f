#include "core/base/io/input_file.hpp"

#include <system_error>

namespace fusebench::io {

std::ifstream input_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) return std::ifstream(file, std::ios::binary);
  std::ifstream none;
  none.setstate(std::ios::failbit);
  return none;
}

bool is_named(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
}

}  // namespace fusebench::io
