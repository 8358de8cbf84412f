#include "eval/cli/console/console.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>

#include "eval/cli/console/progress.hpp"
#include "eval/record/truth_contradiction.hpp"
#include "eval/text/control_characters.hpp"

namespace fusebench::cli::console {

namespace {

/// Whether standard output is a pipe without a reader.
bool reader_has_left() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

}  // namespace

void prepare_standard_streams() {
  constexpr std::array kModes = {O_RDONLY, O_RDONLY, O_WRONLY};  // of input, output, errors
  for (int stream = 0; stream < 3; ++stream) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest number that is free, which is this one: those below are open.
    const int opened = open("/dev/null", kModes[static_cast<std::size_t>(stream)]);
    if (opened != stream) return;  // no /dev/null: as it was
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of a shell is a write that fails
}

void print_error(const Error& error) {
  write_error(fmt::format("error: {}\n", text::without_controls(error.message)));
  if (!error.hint.empty()) write_error(fmt::format("  hint: {}\n", text::without_controls(error.hint)));
}

void print_output(std::string_view text) { write_output(text); }

bool output_arrived() {
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return true;
  if (reader_has_left()) {
    // `| head` has what it wanted: the end that a pipeline expects, without a word.
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  print_error(
      {ErrorCode::io, "standard output cannot be written", "is there free space at its destination?"});
  return false;
}

void print_progress(std::string_view line) { write_error(fmt::format("{}\n", text::without_controls(line))); }

void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) print_progress("warning: " + warning);
}

std::string summary_line(const record::RunRecord& record) {
  std::string line;
  if (const auto contradiction = record::noted_contradiction(record))
    line += fmt::format("{}, but {}; ", record::to_string(record.status), *contradiction);
  if (const auto& aie = record.metrics.aie.value) line += fmt::format("AIE {:.3f}, ", aie->all.aie_grey);
  if (const auto& ate = record.metrics.ate.value) {
    line += fmt::format("ATE {:.2f} cm", 100 * ate->stats.rmse);
    if (record.final_metrics && record.final_metrics->ate.value)
      line += fmt::format(" (final {:.2f} cm)", 100 * record.final_metrics->ate.value->stats.rmse);
    line += ", ";
  }
  line += fmt::format("{}/{} frames", record.frames.tracked, record.frames.total);
  if (const std::string segments = record::segments_text(record.frames); !segments.empty())
    line += ", " + segments;
  // Imported runs have no times.
  if (record.timing.fps > 0) line += fmt::format(", {:.1f} fps", record.timing.fps);
  if (const std::size_t silent = record.metrics.silent_frames().value_or(0); silent > 0)
    line += fmt::format(", {} undetected failure{}", silent, silent == 1 ? "" : "s");
  return line;
}

}  // namespace fusebench::cli::console
