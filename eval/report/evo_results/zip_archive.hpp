// Files in a ZIP archive, as PKWARE's APPNOTE.TXT 6.3.10 lays them out. The only user of zlib in this room.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::evo_results {

struct ZipEntry {
  std::string name;  ///< relative, folders separated by '/'
  std::string bytes;
};

/// An archive of these files, stored as they are (method 0, as Python's zipfile has it), without a time: the
/// same files give the same bytes. Error usage: more than the 4 GiB or 65534 files that the format without
/// its 64-bit extension has room for.
[[nodiscard]] Result<std::string> zip_bytes(const std::vector<ZipEntry>& entries);

/// The archive itself, and all that is in it, are at most as large as this.
inline constexpr std::size_t kMostZipBytes = std::size_t{1} << 30;

/// The files of an archive in the order of its directory, stored or deflated (methods 0 and 8).
///
/// Errors name the file: data_missing; data_corrupt for what is no archive, damage (bounds, sizes, CRC-32),
/// encryption, other methods, the 64-bit extension, several volumes, and more than kMostZipBytes.
[[nodiscard]] Result<std::vector<ZipEntry>> read_zip(const std::filesystem::path& file);

}  // namespace fusebench::evo_results
