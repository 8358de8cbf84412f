#include "eval/record/process_meter.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>

namespace fusebench::record {

namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The text after "name" and a colon in a file of the proc file system.
std::string proc_field(const char* file, const std::string& name) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(name)) continue;
    const auto value = line.find_first_not_of(" \t", line.find(':') + 1);
    return value == std::string::npos ? "" : line.substr(value);
  }
  return "";
}

std::uint64_t peak_rss_bytes() {
  std::istringstream field(proc_field("/proc/self/status", "VmHWM"));
  std::uint64_t kilobytes = 0;
  if (field >> kilobytes) return kilobytes * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

ProcessMeter::ProcessMeter() : start_(std::chrono::steady_clock::now()), cpu_start_s_(cpu_seconds()) {
  // "5" resets VmHWM, so that the second run of a process does not report the first one's peak.
  std::ofstream("/proc/self/clear_refs") << "5";
}

ProcessCost ProcessMeter::cost() const {
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(),
          cpu_seconds() - cpu_start_s_, peak_rss_bytes()};
}

void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

std::string cpu_model() {
  const auto field = [](const char* name) { return proc_field("/proc/cpuinfo", name); };
  const std::string name = field("model name");
  if (name.empty()) return "unknown";
  // Virtual machines of different kinds share a name; libraries choose their code by what is behind it.
  const bool wide = field("flags").find("avx512f") != std::string::npos;
  return fmt::format("{} (family {} model {}{})", name, field("cpu family"), field("model\t"),
                     wide ? ", AVX-512" : "");
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

}  // namespace fusebench::record
