// Binary files of little-endian numbers, as .klg and .sens are.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/base/error.hpp"

namespace fusebench::image_logs {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

template <class Number>
void append_number(std::string& bytes, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  bytes.append(raw.data(), raw.size());
}

/// Reads a file from its beginning and keeps the first error: what is read after it is zero or empty, so that
/// callers ask for error() once a record is complete. Nothing larger than the file is allocated.
class LittleEndianReader {
 public:
  /// Errors: data_missing.
  [[nodiscard]] static Result<LittleEndianReader> open(const std::filesystem::path& file);

  /// what: names the number in the message of an error, data_corrupt, if the file ends before it.
  template <class Number>
  [[nodiscard]] Number number(std::string_view what) {
    static_assert(std::is_arithmetic_v<Number>);
    std::array<char, sizeof(Number)> raw{};
    take(raw.data(), raw.size(), what);
    return error_ ? Number{} : std::bit_cast<Number>(raw);
  }
  [[nodiscard]] std::string bytes(std::uint64_t count, std::string_view what);
  void skip(std::uint64_t count, std::string_view what);

  /// Records data_corrupt with the file and the position, unless there is an error already.
  void complain(std::string_view what);

  [[nodiscard]] std::uint64_t position() const { return position_; }
  [[nodiscard]] std::uint64_t left() const { return size_ - position_; }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  LittleEndianReader(std::string file, std::ifstream stream, std::uint64_t size);
  void take(char* target, std::uint64_t count, std::string_view what);
  [[nodiscard]] bool holds(std::uint64_t count, std::string_view what);

  std::string file_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::optional<Error> error_;
};

}  // namespace fusebench::image_logs
