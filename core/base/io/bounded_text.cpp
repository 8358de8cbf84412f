#include "core/base/io/bounded_text.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "core/base/io/input_file.hpp"

namespace fusebench::io {

bool next_line(std::istream& stream, std::string& line) {
  line.clear();
  std::streambuf& bytes = *stream.rdbuf();
  using Traits = std::istream::traits_type;
  const std::istream::sentry ready(stream, true);
  if (!ready) return false;
  try {
    for (auto next = bytes.sbumpc(); !Traits::eq_int_type(next, Traits::eof()); next = bytes.sbumpc()) {
      const char c = Traits::to_char_type(next);
      if (c == '\n') return true;
      if (line.size() == kMostLineBytes) {
        stream.setstate(std::ios::badbit);
        return false;
      }
      line += c;
    }
  } catch (const std::ios_base::failure&) {  // of the disk, which getline() would not throw either
    stream.setstate(std::ios::badbit);
    return false;
  }
  stream.setstate(line.empty() ? std::ios::eofbit | std::ios::failbit : std::ios::eofbit);
  return !line.empty();
}

Result<std::string> whole_text(const std::filesystem::path& file, std::uintmax_t most_bytes,
                               std::string_view what) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream = input_file(file);
  if (error || !stream)
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  if (size > most_bytes)
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {} bytes, more than any {} has ({})", file.string(),
                                                     size, what, most_bytes));
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad())
    return fail(ErrorCode::data_corrupt, fmt::format("{}: cannot be read to its end", file.string()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace fusebench::io
