// What every child of this process does first, and what ended ones used and printed.
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>

namespace fusebench::process {

/// In a child that was just forked: it dies with `parent`, has a process group of its own (Ctrl-C is for the
/// parent, which asks its children in its turn), reads nothing, writes standard output and error to `output`,
/// leaves no core, and has at most so many bytes of data (0: no limit).
void set_up_child(pid_t parent, int output, std::uint64_t memory_bytes);

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
