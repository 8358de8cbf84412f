// What the command line shows: errors and progress on standard error, results on standard output.
//
// Nothing that cannot be shown on standard error ends a verb: it is left out, be the disk full, the
// descriptor closed, or the reader of a pipe gone.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"

namespace fusebench::cli::console {

inline constexpr int kExitRunFailed = 4;

/// First of all in a process. A standard descriptor that the caller closed would be given to the first file
/// that is opened, and that file then hold what is printed: each is opened on /dev/null instead, standard
/// output so that writing to it fails. A pipe without a reader is an error of writing, no signal.
void prepare_standard_streams();

/// "error: <sentence>" and "  hint: ..." on standard error.
void print_error(const Error& error);
void print_output(std::string_view text);  ///< standard output
/// Once, at the end: false, with an error, if standard output could not take all of it (a full disk, a closed
/// descriptor). Where it is a pipe whose reader has left, the process ends by SIGPIPE.
[[nodiscard]] bool output_arrived();
void print_progress(std::string_view line);                  ///< a line on standard error
void print_warnings(std::span<const std::string> warnings);  ///< a line each: "warning: ..."

/// "AIE 8.123, ATE 2.31 cm, 240/240 frames, 31.2 fps"; what a run without these says instead.
[[nodiscard]] std::string summary_line(const record::RunRecord& record);

}  // namespace fusebench::cli::console
