// Output of the command line: errors and messages on standard error, results on standard output.
//
// Errors of writing to standard error (full disk, closed descriptor, pipe without a reader) are ignored.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"

namespace fusebench::cli::console {

inline constexpr int kExitRunFailed = 4;

/// Call first in a process. Opens closed standard descriptors on /dev/null, because the first opened file
/// would otherwise get the number and the printed text; writing to such a standard output fails. A pipe
/// without a reader is an error of writing, not a signal.
void prepare_standard_streams();

/// "error: <sentence>" and "  hint: ..." on standard error.
void print_error(const Error& error);
void print_output(std::string_view text);  ///< standard output
/// Once, at the end: false, with an error, if standard output could not take all of it (a full disk, a closed
/// descriptor). Where it is a pipe whose reader has left, the process ends by SIGPIPE.
[[nodiscard]] bool output_arrived();
void print_progress(std::string_view line);                  ///< a line on standard error
void print_warnings(std::span<const std::string> warnings);  ///< a line each: "warning: ..."

/// "AIE 8.123, ATE 2.31 cm, 240/240 frames, 31.2 fps", as far as the run has these values.
[[nodiscard]] std::string summary_line(const record::RunRecord& record);

}  // namespace fusebench::cli::console
