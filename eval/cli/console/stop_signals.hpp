// Handling of Ctrl-C (SIGINT) and SIGTERM.
#pragma once

#include <atomic>

namespace fusebench::cli::console {

inline constexpr int kExitInterrupted = 130;  ///< 128 + SIGINT, as in shells

/// How the process ends at a signal, always with kExitInterrupted.
enum class OnStop {
  end,         ///< at once, without its temporary files
  end_soon,    ///< the work checks stop_requested(); as with `end` if it does not stop within kMostStop_s
  end_itself,  ///< the work checks stop_requested(), stops its child processes and keeps finished results
};

inline constexpr double kMostStop_s = 0.7;

/// For the whole process: OnStop::end. To be called before any work.
void handle_stop_signals();

/// Set by a signal within a StopScope.
[[nodiscard]] const std::atomic<bool>& stop_requested();

/// Changes OnStop while this lives. Only one may live at a time. A third signal ends the
/// process at once in any case.
class StopScope {
 public:
  explicit StopScope(OnStop on_stop);
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  ~StopScope();
};

}  // namespace fusebench::cli::console
