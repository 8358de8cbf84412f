#include "eval/cli/trajectories/transcript.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/base/io/staged_file.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"

namespace fusebench::cli::trajectories {

void add_transcript_options(CLI::App& verb, TranscriptOptions& options, const char* what_verbose_does) {
  verb.add_flag("--silent", options.silent, "Prints errors only");
  verb.add_option("--logfile", options.logfile, "Appends the output to FILE, also with --silent")
      ->type_name("FILE");
  verb.add_flag("-v,--verbose,--debug", options.verbose, what_verbose_does);
  verb.add_flag("--no_warnings", options.no_warnings,
                "Accepted for compatibility with evo: files are written without a question");
}

Transcript::Transcript(const TranscriptOptions& options) : options_(options) {
  if (options.silent) console::hide_progress();
}

void Transcript::note(std::string_view line) {
  said_ += fmt::format("{}\n", line);
  if (!options_.silent) console::print_progress(line);
}

void Transcript::warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) note("warning: " + warning);
}

void Transcript::result(std::string_view text) {
  said_ += text;
  if (!options_.silent) console::print_output(text);
}

Result<void> Transcript::finish() const {
  if (options_.logfile.empty()) return {};
  if (io::is_replaced_link(options_.logfile))
    return fail(ErrorCode::usage,
                fmt::format("--logfile {}: a symbolic link, whose target would be changed",
                            options_.logfile.string()),
                "pass the file itself: the output is appended to it");
  std::error_code ignored;  // opening reports the error
  if (options_.logfile.has_parent_path())
    std::filesystem::create_directories(options_.logfile.parent_path(), ignored);
  std::ofstream stream(options_.logfile, std::ios::app | std::ios::binary);
  stream << said_;
  stream.close();
  if (stream) return {};
  return fail(ErrorCode::io, fmt::format("--logfile {}: cannot be written", options_.logfile.string()),
              "choose a file in a folder that can be written");
}

}  // namespace fusebench::cli::trajectories
