#include "eval/cli/console/stop_signals.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

#include "core/base/io/temporary_mark.hpp"

namespace fusebench::cli::console {

namespace {

// A signal handler can reach nothing but static storage.
std::atomic<bool>& stop_flag() {
  static std::atomic<bool> flag = false;
  static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
  return flag;
}

std::atomic<OnStop>& how_to_stop() {
  static std::atomic<OnStop> how = OnStop::end;
  static_assert(std::atomic<OnStop>::is_always_lock_free, "as for the flag");
  return how;
}

extern "C" void end_the_process(int /*signal*/) {
  io::remove_marked_places();
  constexpr std::string_view kMessage = "error: stopped by the user\n";
  static_cast<void>(!write(STDERR_FILENO, kMessage.data(), kMessage.size()));
  _exit(kExitInterrupted);
}

extern "C" void on_stop_signal(int signal) {
  const OnStop how = how_to_stop().load();
  if (how == OnStop::end) end_the_process(signal);
  // After a second one, which a parent may have passed on, the next ends the process at once.
  if (stop_flag().exchange(true)) {
    std::signal(signal, SIG_DFL);
    return;
  }
  if (how != OnStop::end_soon) return;
  const int interrupted_error = errno;
  itimerval limit{};
  limit.it_value.tv_usec = static_cast<suseconds_t>(1e6 * kMostStop_s);
  setitimer(ITIMER_REAL, &limit, nullptr);
  errno = interrupted_error;
}

}  // namespace

const std::atomic<bool>& stop_requested() { return stop_flag(); }

void handle_stop_signals() {
  std::signal(SIGALRM, end_the_process);
  std::signal(SIGINT, on_stop_signal);
  std::signal(SIGTERM, on_stop_signal);
}

StopScope::StopScope(OnStop on_stop) { how_to_stop().store(on_stop); }

StopScope::~StopScope() { how_to_stop().store(OnStop::end); }

}  // namespace fusebench::cli::console
