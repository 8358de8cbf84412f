#include "eval/cli/console/stack_size.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>

#include "eval/cli/console/console.hpp"

namespace fusebench::cli::console {

namespace {

struct Call {
  const std::function<int()>& function;
  int result = 0;
};

extern "C" void* call_in_thread(void* argument) {
  auto* const call = static_cast<Call*>(argument);
  call->result = call->function();
  return nullptr;
}

}  // namespace

int call_with_enough_stack(const std::function<int()>& function) {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= kLeastStackBytes) return function();
  Call call{function};
  pthread_attr_t attributes;
  pthread_t thread{};
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kLargeStackBytes);
  const bool created = pthread_setattr_default_np(&attributes) == 0 &&
                       pthread_create(&thread, &attributes, call_in_thread, &call) == 0;
  pthread_attr_destroy(&attributes);
  if (created) {
    pthread_join(thread, nullptr);
    return call.result;
  }
  print_progress(
      fmt::format("warning: the stack is limited to {} kB, which may be too little: raise the limit "
                  "(ulimit -s 8192)",
                  limit.rlim_cur / 1024));
  return function();
}

}  // namespace fusebench::cli::console
