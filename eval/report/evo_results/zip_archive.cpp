#include "eval/report/evo_results/zip_archive.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>

#include "core/base/io/input_file.hpp"
#include "core/base/printable.hpp"

namespace fusebench::evo_results {

namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kDirectoryHeader = 0x02014b50;
constexpr std::uint32_t kEndOfDirectory = 0x06054b50;
constexpr std::size_t kLocalHeaderBytes = 30;
constexpr std::size_t kDirectoryHeaderBytes = 46;
constexpr std::size_t kEndOfDirectoryBytes = 22;
constexpr std::uint16_t kStored = 0;
constexpr std::uint16_t kDeflated = 8;
constexpr std::uint16_t kEncrypted = 0x0001;
constexpr std::uint16_t kNameIsUtf8 = 0x0800;

/// The number's lowest byte first, as everywhere in the format.
void put(std::string& bytes, std::uint64_t number, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFF);
}

/// Of what lies within the bytes.
std::uint32_t number_at(std::string_view bytes, std::size_t offset, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  return number;
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// What a local header and the directory both say of a file, from the version that is needed on.
void put_description(std::string& bytes, const ZipEntry& entry) {
  constexpr std::uint64_t kVersion = 20;       // folders
  constexpr std::uint64_t kDate = 1 << 5 | 1;  // the first day that there is: 1980-01-01
  put(bytes, kVersion, 2);
  put(bytes, kNameIsUtf8, 2);
  put(bytes, kStored, 2);
  put(bytes, 0, 2);  // time of day
  put(bytes, kDate, 2);
  put(bytes, checksum(entry.bytes), 4);
  put(bytes, entry.bytes.size(), 4);
  put(bytes, entry.bytes.size(), 4);
  put(bytes, entry.name.size(), 2);
  put(bytes, 0, 2);  // extra field
}

tl::unexpected<Error> corrupt(const std::filesystem::path& file, std::string_view what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what),
              "a result is a .zip file as --save_results writes it");
}

Result<std::string> content(const std::filesystem::path& file) {
  std::ifstream stream = io::input_file(file);
  std::error_code no_size;
  const auto size = std::filesystem::file_size(file, no_size);
  if (!stream || no_size)
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  if (size > kMostZipBytes) return corrupt(file, "is larger than 1 GiB, and no archive of results");
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) return corrupt(file, "cannot be read to its end");
  return bytes;
}

/// The record at the end; a comment of up to 65535 bytes may follow it.
std::optional<std::size_t> end_of_directory(std::string_view bytes) {
  constexpr std::size_t kLongestComment = std::numeric_limits<std::uint16_t>::max();
  if (bytes.size() < kEndOfDirectoryBytes) return std::nullopt;
  const std::size_t last = bytes.size() - kEndOfDirectoryBytes;
  const std::size_t first = last - std::min(last, kLongestComment);
  for (std::size_t at = last + 1; at-- > first;) {
    if (number_at(bytes, at, 4) == kEndOfDirectory) return at;
  }
  return std::nullopt;
}

/// What the directory says of a file.
struct Listed {
  std::string name;
  std::uint16_t flags = 0;
  std::uint16_t method = 0;
  std::uint32_t checksum = 0;
  std::size_t packed_size = 0;
  std::size_t size = 0;
  std::size_t header = 0;  // offset
};

Result<std::vector<Listed>> directory(const std::filesystem::path& file, std::string_view bytes) {
  const auto end = end_of_directory(bytes);
  if (!end) return corrupt(file, "is no ZIP archive, or was cut off");
  const std::size_t count = number_at(bytes, *end + 10, 2);
  std::size_t at = number_at(bytes, *end + 16, 4);
  if (number_at(bytes, *end + 4, 2) != 0) return corrupt(file, "is one of several volumes of an archive");
  if (count == std::numeric_limits<std::uint16_t>::max())
    return corrupt(file, "uses the 64-bit extension of ZIP, for more files than results are");
  std::vector<Listed> listed;
  for (std::size_t i = 0; i < count; ++i) {
    if (at > *end || *end - at < kDirectoryHeaderBytes || number_at(bytes, at, 4) != kDirectoryHeader)
      return corrupt(file, fmt::format("the directory of the archive ends after {} of {} files", i, count));
    Listed entry;
    entry.flags = static_cast<std::uint16_t>(number_at(bytes, at + 8, 2));
    entry.method = static_cast<std::uint16_t>(number_at(bytes, at + 10, 2));
    entry.checksum = number_at(bytes, at + 16, 4);
    entry.packed_size = number_at(bytes, at + 20, 4);
    entry.size = number_at(bytes, at + 24, 4);
    entry.header = number_at(bytes, at + 42, 4);
    const std::size_t name_size = number_at(bytes, at + 28, 2);
    const std::size_t size =
        kDirectoryHeaderBytes + name_size + number_at(bytes, at + 30, 2) + number_at(bytes, at + 32, 2);
    if (*end - at < size) return corrupt(file, "a name in the directory of the archive is cut off");
    entry.name = bytes.substr(at + kDirectoryHeaderBytes, name_size);
    listed.push_back(std::move(entry));
    at += size;
  }
  return listed;
}

/// A deflated stream (RFC 1951) that makes exactly so many bytes.
std::optional<std::string> inflated(std::string_view packed, std::size_t size) {
  // A file may claim any size, but one byte makes at most 1032.
  constexpr std::size_t kMostPerByte = 1032;
  if (size / kMostPerByte > packed.size()) return std::nullopt;
  std::string bytes(size, '\0');
  z_stream stream{};
  constexpr int kWithoutHeader = -MAX_WBITS;
  if (inflateInit2(&stream, kWithoutHeader) != Z_OK) return std::nullopt;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib does not write there
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int done = inflate(&stream, Z_FINISH);
  const bool whole = done == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  if (!whole) return std::nullopt;
  return bytes;
}

Result<ZipEntry> unpacked(const std::filesystem::path& file, std::string_view bytes, const Listed& listed) {
  const std::string name = printable(listed.name);
  const auto damaged = [&](std::string_view what) {
    return corrupt(file, fmt::format("{}: {}", name, what));
  };
  if ((listed.flags & kEncrypted) != 0) return damaged("is encrypted");
  if (listed.method != kStored && listed.method != kDeflated)
    return damaged(fmt::format("is packed by method {} (stored is 0, deflated 8)", listed.method));
  if (listed.header > bytes.size() || bytes.size() - listed.header < kLocalHeaderBytes ||
      number_at(bytes, listed.header, 4) != kLocalHeader)
    return damaged("is not at the offset in the archive's directory");
  const std::size_t begin = listed.header + kLocalHeaderBytes + number_at(bytes, listed.header + 26, 2) +
                            number_at(bytes, listed.header + 28, 2);
  if (begin > bytes.size() || bytes.size() - begin < listed.packed_size) return damaged("is cut off");
  const std::string_view packed = bytes.substr(begin, listed.packed_size);
  std::optional<std::string> plain;
  if (listed.method == kDeflated)
    plain = inflated(packed, listed.size);
  else if (packed.size() == listed.size)
    plain = std::string(packed);
  if (!plain) return damaged("does not unpack to the size in the archive's directory");
  if (checksum(*plain) != listed.checksum) return damaged("is damaged (its CRC-32 differs)");
  return ZipEntry{listed.name, std::move(*plain)};
}

}  // namespace

Result<std::string> zip_bytes(const std::vector<ZipEntry>& entries) {
  constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();
  constexpr std::size_t kMostName = std::numeric_limits<std::uint16_t>::max();
  std::size_t size = kEndOfDirectoryBytes;
  for (const ZipEntry& entry : entries) {
    size += entry.bytes.size() + kLocalHeaderBytes + kDirectoryHeaderBytes + 2 * entry.name.size();
    if (entry.name.size() > kMostName)
      return fail(ErrorCode::usage, fmt::format("a name of {} letters in an archive", entry.name.size()));
  }
  if (size > kMostBytes || entries.size() >= kMostName)
    return fail(ErrorCode::usage,
                fmt::format("a ZIP archive has no room for {} bytes in {} files", size, entries.size()),
                "--downsample N leaves fewer poses");
  std::string bytes;
  bytes.reserve(size);
  std::string listing;
  for (const ZipEntry& entry : entries) {
    constexpr std::uint64_t kMadeByUnix = 3 << 8 | 20;
    constexpr std::uint64_t kPlainFile = 0100644;  // of whom everybody may read
    put(listing, kDirectoryHeader, 4);
    put(listing, kMadeByUnix, 2);
    put_description(listing, entry);
    put(listing, 0, 2 + 2 + 2);  // comment, volume, kind of content
    put(listing, kPlainFile << 16, 4);
    put(listing, bytes.size(), 4);
    listing += entry.name;
    put(bytes, kLocalHeader, 4);
    put_description(bytes, entry);
    bytes += entry.name;
    bytes += entry.bytes;
  }
  const std::size_t begin = bytes.size();
  bytes += listing;
  put(bytes, kEndOfDirectory, 4);
  put(bytes, 0, 2 + 2);  // of volumes there is one
  put(bytes, entries.size(), 2);
  put(bytes, entries.size(), 2);
  put(bytes, listing.size(), 4);
  put(bytes, begin, 4);
  put(bytes, 0, 2);  // comment
  return bytes;
}

Result<std::vector<ZipEntry>> read_zip(const std::filesystem::path& file) {
  const auto bytes = content(file);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto listed = directory(file, *bytes);
  if (!listed) return tl::unexpected(listed.error());
  std::vector<ZipEntry> entries;
  std::size_t total = 0;
  for (const Listed& entry : *listed) {
    constexpr std::size_t kElsewhere = std::numeric_limits<std::uint32_t>::max();
    if (entry.size == kElsewhere || entry.packed_size == kElsewhere || entry.header == kElsewhere)
      return corrupt(file, "uses the 64-bit extension of ZIP, for files larger than results are");
    total += entry.size;
    if (total > kMostZipBytes) return corrupt(file, "holds more than 1 GiB");
    auto plain = unpacked(file, *bytes, entry);
    if (!plain) return tl::unexpected(plain.error());
    entries.push_back(std::move(*plain));
  }
  return entries;
}

}  // namespace fusebench::evo_results
