// What a stretch of work cost this process, and which machine it ran on.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace fusebench::record {

struct ProcessCost {
  double wall_s = 0;
  double cpu_s = 0;                  ///< user and system, of all threads
  std::uint64_t peak_rss_bytes = 0;  ///< largest resident memory since the meter started
};

/// Starts when it is made. The peak is reset where the kernel allows it (Linux); elsewhere it is that of the
/// process.
class ProcessMeter {
 public:
  ProcessMeter();
  [[nodiscard]] ProcessCost cost() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_start_s_;
};

/// Gives memory that was freed back to the system where the C library keeps it (glibc).
void return_freed_memory();

/// "Intel(R) Xeon(R) Processor (family 6 model 143, AVX-512)"; "unknown" if the system does not tell.
[[nodiscard]] std::string cpu_model();
[[nodiscard]] std::string host_name();

}  // namespace fusebench::record
