// Errors as values. Expected failures (bad input, a lost tracker) are returned as Result<T>; programmer
// errors throw InternalError through check(). Libraries neither print nor exit nor abort.
#pragma once

#include <source_location>
#include <stdexcept>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace fusebench {
inline namespace base {

/// Kind of failure; determines the exit code of the command line.
enum class ErrorCode {
  usage,          ///< wrong command line
  configuration,  ///< unknown key, wrong type, out of range
  data_missing,   ///< a file or folder that does not exist
  data_corrupt,   ///< a file that exists but is invalid
  run_failed,     ///< a run ended early (lost tracker, allocation failure)
  io,             ///< the output could not be written
  internal,       ///< a bug
};

/// A message of one sentence with file:line or key = value (allowed range), and a hint on how to fix it.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;
  std::string hint;
};

template <class T>
using Result = tl::expected<T, Error>;

/// Short form of `return tl::unexpected(Error{...})`.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message, std::string hint = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(hint)});
}

/// Exit code of the command line: 2 usage or configuration, 3 data, 4 failed run or output, 5 internal.
[[nodiscard]] constexpr int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
    case ErrorCode::configuration:
      return 2;
    case ErrorCode::data_missing:
    case ErrorCode::data_corrupt:
      return 3;
    case ErrorCode::run_failed:
    case ErrorCode::io:
      return 4;
    case ErrorCode::internal:
      break;
  }
  return 5;
}

/// Thrown by check(): a programmer error, never bad input.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Check for programmer errors, active in all builds. Throws InternalError with the source location.
inline void check(bool condition, const char* what,
                  std::source_location where = std::source_location::current()) {
  if (!condition) {
    throw InternalError(std::string(where.file_name()) + ":" + std::to_string(where.line()) +
                        ": check failed: " + what);
  }
}

}  // namespace base
}  // namespace fusebench
