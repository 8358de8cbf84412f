// What ended processes used, and said.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>

namespace fusebench::process {

/// User and system.
[[nodiscard]] inline double cpu_seconds(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

[[nodiscard]] inline std::uint64_t peak_bytes(const rusage& usage) {
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// The last 16 KiB of a file that was written.
[[nodiscard]] inline std::string end_of_file(std::FILE* file) {
  constexpr long kKept = 16 * 1024;
  std::fseek(file, 0, SEEK_END);
  const long size = std::ftell(file);
  const long kept = std::min(size, kKept);
  std::fseek(file, size - kept, SEEK_SET);
  std::string text(static_cast<std::size_t>(std::max(kept, 0L)), '\0');
  text.resize(std::fread(text.data(), 1, text.size(), file));
  return text;
}

}  // namespace fusebench::process
