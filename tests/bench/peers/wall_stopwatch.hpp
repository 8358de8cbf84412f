// Wall time of a stretch of work.
#pragma once

#include <chrono>

namespace fusebench::peers {

/// Milliseconds since it was made.
class WallStopwatch {
 public:
  [[nodiscard]] double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace fusebench::peers
