// What an inspection found, and the closed list of codes that it may use.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fusebench::inspection {

enum class Severity {
  error,    ///< results on this recording are invalid until it is repaired
  warning,  ///< to be known before results are read
  note,     ///< a fact
};
[[nodiscard]] std::string_view to_string(Severity severity);  ///< "error", "warning", "note"

struct Finding {
  std::string code;  ///< one of finding_codes()
  Severity severity = Severity::note;
  std::string message;  ///< one sentence with the measured numbers
  std::string hint;     ///< what to do; may be empty
};

/// A stable code and what it means, as docs/inspect.md lists it.
struct FindingCode {
  std::string_view code;
  std::string_view meaning;
};
[[nodiscard]] std::span<const FindingCode> finding_codes();

}  // namespace fusebench::inspection
