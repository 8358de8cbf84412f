#include "datasets/recording/image_logs/little_endian.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/base/io/input_file.hpp"

namespace fusebench::image_logs {

LittleEndianReader::LittleEndianReader(std::string file, std::ifstream stream, std::uint64_t size)
    : file_(std::move(file)), stream_(std::move(stream)), size_(size) {}

Result<LittleEndianReader> LittleEndianReader::open(const std::filesystem::path& file) {
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(file, error);
  const std::uintmax_t size = is_file ? std::filesystem::file_size(file, error) : 0;
  std::ifstream stream = io::input_file(file);
  if (!is_file || error || !stream)
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read as a file", file.string()));
  return LittleEndianReader(file.string(), std::move(stream), size);
}

void LittleEndianReader::complain(std::string_view what) {
  if (!error_)
    error_ = Error{ErrorCode::data_corrupt, fmt::format("{}: byte {}: {}", file_, position_, what), {}};
}

bool LittleEndianReader::holds(std::uint64_t count, std::string_view what) {
  if (count > left()) complain(fmt::format("ends before {} ({} bytes, {} are left)", what, count, left()));
  return !error_;
}

void LittleEndianReader::take(char* target, std::uint64_t count, std::string_view what) {
  if (!holds(count, what)) return;
  stream_.read(target, static_cast<std::streamsize>(count));
  if (!stream_) {
    complain(fmt::format("{} cannot be read", what));
    return;
  }
  position_ += count;
}

std::string LittleEndianReader::bytes(std::uint64_t count, std::string_view what) {
  if (!holds(count, what)) return {};
  std::string result(count, '\0');
  take(result.data(), count, what);
  return error_ ? std::string{} : result;
}

void LittleEndianReader::skip(std::uint64_t count, std::string_view what) {
  if (!holds(count, what)) return;
  stream_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
  position_ += count;
}

}  // namespace fusebench::image_logs
