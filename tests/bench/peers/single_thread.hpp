// One thread for every library of this process.
#pragma once

#include <memory>

namespace fusebench::peers {

/// Holds OpenCV, OpenMP and TBB to one thread while it lives. To be made before the first call of a library.
class SingleThread {
 public:
  SingleThread();
  ~SingleThread();
  SingleThread(const SingleThread&) = delete;
  SingleThread& operator=(const SingleThread&) = delete;

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
};

/// How many threads this process has now; 0 if the system does not tell.
[[nodiscard]] int threads_of_process();

}  // namespace fusebench::peers
