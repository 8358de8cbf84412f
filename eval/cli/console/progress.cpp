#include "eval/cli/console/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <utility>

#include "eval/text/control_characters.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::cli::console {

/// The progress line. There is one for the process, as there is one standard error.
class StatusLine {
 public:
  static StatusLine& of_process() {
    static StatusLine line;
    return line;
  }

  void write(std::FILE* stream, std::string_view text) {
    const std::lock_guard lock(mutex_);
    remove();
    std::fwrite(text.data(), 1, text.size(), stream);
    if (stream != stderr) return;
    std::fflush(stderr);
    last_output_ = Clock::now();
  }

  void hide() {
    const std::lock_guard lock(mutex_);
    hidden_ = true;
  }

  void begin(Progress& work) {
    const std::lock_guard lock(mutex_);
    work.before_ = std::exchange(current_, &work);
  }

  void end(const Progress& work) {
    const std::lock_guard lock(mutex_);
    remove();
    current_ = work.before_;
  }

  void say(Progress& work, std::string what) {
    const std::lock_guard lock(mutex_);
    work.what_ = std::move(what);
    work.total_ = 0;
    draw_if_due();
  }

  void show(Progress& work, std::size_t done, std::size_t total) {
    const std::lock_guard lock(mutex_);
    work.done_ = done;
    work.total_ = total;
    draw_if_due();
  }

  void tick() {
    const std::lock_guard lock(mutex_);
    draw_if_due();
  }

 private:
  using Clock = std::chrono::steady_clock;

  void remove() {
    if (!std::exchange(drawn_, false)) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
  }

  void draw_if_due() {
    constexpr std::chrono::milliseconds kRedraw(200);
    constexpr std::chrono::seconds kSilence(5);
    const auto now = Clock::now();
    const bool due = terminal_ ? now - last_output_ >= kRedraw : now - last_output_ >= kSilence;
    if (hidden_ || current_ == nullptr || !due) return;
    last_output_ = now;
    const std::string line = text_of(*current_, now);
    const std::string text = terminal_ ? fmt::format("\r\033[K{}", line) : fmt::format("... {}\n", line);
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
    drawn_ = terminal_;
  }

  [[nodiscard]] std::string text_of(const Progress& work, Clock::time_point now) const {
    constexpr std::size_t kUsualWidth = 150;
    constexpr std::size_t kBar = 30;
    std::string line = text::without_controls(work.what_);
    if (work.total_ > 0) {
      const std::size_t filled = std::min(kBar, kBar * work.done_ / work.total_);
      if (terminal_)
        line += fmt::format(" [{}{}]", std::string(filled, '#'), std::string(kBar - filled, '.'));
      line += fmt::format("{} {}/{}", terminal_ ? "" : ":", work.done_, work.total_);
    }
    const std::string time =
        fmt::format(" ({})", text::duration_text(std::chrono::duration<double>(now - work.start_).count()));
    winsize size{};
    const bool told = terminal_ && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20;
    const std::size_t width = (told ? size.ws_col - 1U : kUsualWidth) - time.size();
    if (line.size() > width) line = line.substr(0, width - 3) + "...";
    return line + time;
  }

  std::mutex mutex_;
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  bool hidden_ = false;
  bool drawn_ = false;
  Clock::time_point last_output_ = Clock::now();
  Progress* current_ = nullptr;
};

void write_error(std::string_view text) { StatusLine::of_process().write(stderr, text); }

void write_output(std::string_view text) { StatusLine::of_process().write(stdout, text); }

void hide_progress() { StatusLine::of_process().hide(); }

Progress::Progress(std::string what) : what_(std::move(what)) { StatusLine::of_process().begin(*this); }

Progress::~Progress() { StatusLine::of_process().end(*this); }

void Progress::say(std::string what) { StatusLine::of_process().say(*this, std::move(what)); }

void Progress::show(std::size_t done, std::size_t total) {
  StatusLine::of_process().show(*this, done, total);
}

Heartbeat::Heartbeat() {
  // Signals are for the thread that works: their handlers interrupt its system calls.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread_ = std::jthread([](const std::stop_token& stop) {
      constexpr std::chrono::milliseconds kTick(200);
      std::mutex mutex;
      std::condition_variable_any wait;
      std::unique_lock lock(mutex);
      while (!wait.wait_for(lock, stop, kTick, [&] { return stop.stop_requested(); }))
        StatusLine::of_process().tick();
    });
  } catch (const std::system_error&) {
    // Without a thread, only work that calls its Progress is shown.
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace fusebench::cli::console
