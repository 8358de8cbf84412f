// What long work does, on standard error: one line that is redrawn on a terminal; elsewhere a line
// "... WHAT: DONE/TOTAL (12 s)" after every 5 s without other output there.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <thread>

namespace fusebench::cli::console {

/// Writes to standard error or output, with the progress line removed before.
void write_error(std::string_view text);
void write_output(std::string_view text);

/// Shows no progress in this process (evo's --silent).
void hide_progress();

/// The current work of the process while this object lives. One that is created later hides it for as long as
/// it lives itself. The counts need not be given.
class Progress {
 public:
  explicit Progress(std::string what);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  void say(std::string what);  ///< replaces the text and removes the counts
  void show(std::size_t done, std::size_t total);

 private:
  friend class StatusLine;
  std::string what_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Progress* before_;
};

/// Shows the current Progress while the work does not call it, from a thread of its own: the process must not
/// fork work while this lives (process::ForkedJob).
class Heartbeat {
 public:
  Heartbeat();

 private:
  std::jthread thread_;
};

}  // namespace fusebench::cli::console
