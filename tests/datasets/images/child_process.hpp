// Runs something in a process of its own, to see how much memory it takes and to survive it.
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

namespace fusebench::testing {

// Sanitizers keep memory of their own, far beyond any limit here.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kMemoryIsMeasured = false;
#else
inline constexpr bool kMemoryIsMeasured = true;
#endif

struct ChildResult {
  bool ended_well = false;
  std::string text;            ///< what the work returned
  std::size_t peak_bytes = 0;  ///< resident, with what the parent had when the child began
};

/// Memory of this process that may be written to, resident or not.
inline std::size_t data_bytes() {
  std::ifstream stream("/proc/self/statm");
  std::size_t pages = 0;
  for (int field = 0; field < 6; ++field) stream >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// limit_bytes: of memory beyond that of the parent; then allocations fail, instead of the machine.
inline ChildResult run_in_child(std::size_t limit_bytes, const std::function<std::string()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    close(ends[0]);
    if (kMemoryIsMeasured) {
      const std::size_t most = data_bytes() + limit_bytes;
      const rlimit limit{most, most};
      setrlimit(RLIMIT_DATA, &limit);
    }
    std::string text;
    try {
      text = work();
    } catch (const std::exception& error) {
      text = std::string("threw ") + error.what();
    }
    const bool sent = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  ChildResult result;
  char part[4096];
  for (ssize_t count = 0; (count = read(ends[0], part, sizeof(part))) > 0;)
    result.text.append(part, static_cast<std::size_t>(count));
  close(ends[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  result.ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  result.peak_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
  return result;
}

}  // namespace fusebench::testing
