#include "eval/cli/console/table_width.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace fusebench::cli::console {

namespace {

constexpr std::size_t kUsualWidth = 100;  // of a terminal without a size, such as a serial line
constexpr int kWidestLine = 10000;

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* const given = std::getenv("COLUMNS");
  const std::string_view text = given == nullptr ? "" : given;
  std::size_t columns = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), columns);
  const bool number = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  return number && columns > 0 ? columns : kUsualWidth;
}

}  // namespace

void add_width_option(CLI::App& verb, std::optional<std::size_t>& width) {
  verb.add_option("--width", width,
                  "Width of text tables in characters: longer cells continue on the next line, and wider "
                  "tables are split into blocks of columns; 0: no limit. Default: the terminal's width; 0 "
                  "elsewhere and for Markdown")
      ->check(CLI::Range(0, kWidestLine))
      ->type_name("N");
}

std::size_t table_width(const std::optional<std::size_t>& asked, bool format_was_named) {
  if (asked) return *asked;
  return isatty(STDOUT_FILENO) == 1 && !format_was_named ? terminal_width() : 0;
}

}  // namespace fusebench::cli::console
