// CPU time of a stretch of work.
#pragma once

#include <ctime>

namespace fusebench::peers {

/// Milliseconds of CPU, user and system, that all threads of this process have used since it was made: a
/// library that starts threads of its own does not look faster by them, and other programs do not count.
class CpuStopwatch {
 public:
  [[nodiscard]] double milliseconds() const { return now_ms() - start_ms_; }

 private:
  [[nodiscard]] static double now_ms() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  }

  double start_ms_ = now_ms();
};

}  // namespace fusebench::peers
