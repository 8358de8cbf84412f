#include "tests/bench/peers/single_thread.hpp"

#include <omp.h>
#include <oneapi/tbb/global_control.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <opencv2/core/utility.hpp>
#include <system_error>

namespace fusebench::peers {

struct SingleThread::Limit {
  tbb::global_control tbb{tbb::global_control::max_allowed_parallelism, 1};
};

SingleThread::SingleThread() : limit_(std::make_unique<Limit>()) {
  // Open3D asks for as many threads as there are cores unless this variable is set, whatever OpenMP was told.
  setenv("OMP_NUM_THREADS", "1", 1);
  omp_set_num_threads(1);  // the runtime has read its variables before main()
  cv::setNumThreads(1);
}

SingleThread::~SingleThread() = default;

int threads_of_process() {
  std::error_code none;
  const std::filesystem::directory_iterator tasks("/proc/self/task", none);
  return none ? 0 : static_cast<int>(std::distance(begin(tasks), end(tasks)));
}

}  // namespace fusebench::peers
