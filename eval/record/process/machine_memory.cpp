#include "eval/record/process/machine_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace fusebench::process {

namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max() / 4;

std::optional<std::uint64_t> meminfo_bytes(std::string_view name) {
  std::ifstream file("/proc/meminfo");
  std::string key;
  std::uint64_t kilobytes = 0;
  for (std::string unit; file >> key >> kilobytes; std::getline(file, unit)) {
    if (key == name) return kilobytes * 1024;
  }
  return std::nullopt;
}

/// A number in a file of control groups; nothing for "max" or no such file.
std::optional<std::uint64_t> number_in(const char* file) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  if (stream >> value) return value;
  return std::nullopt;
}

std::uint64_t cached_file_bytes() {
  std::ifstream stream("/sys/fs/cgroup/memory.stat");
  std::uint64_t sum = 0;
  std::string key;
  for (std::uint64_t bytes = 0; stream >> key >> bytes;) {
    if (key == "inactive_file" || key == "active_file") sum += bytes;
  }
  return sum;
}

}  // namespace

std::uint64_t available_memory_bytes() {
  const std::uint64_t machine = meminfo_bytes("MemAvailable:").value_or(kUnknown);
  const auto limit = number_in("/sys/fs/cgroup/memory.max");
  const auto used = number_in("/sys/fs/cgroup/memory.current");
  if (!limit || !used) return machine;
  // What files have in memory is given back when somebody needs it.
  const std::uint64_t needed = *used - std::min(*used, cached_file_bytes());
  return std::min(machine, *limit > needed ? *limit - needed : 0);
}

}  // namespace fusebench::process
