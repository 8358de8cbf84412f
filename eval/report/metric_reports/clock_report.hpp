// The fitted offset of a reference's clock, for people.
#pragma once

#include <string>

#include "eval/metrics/reference_clock/clocked_errors.hpp"

namespace fusebench::metric_reports {

/// "t_reference = t_estimate + 0.06718 s, standard deviation 0.00201 s (1786 motions)".
[[nodiscard]] std::string offset_text(const reference_clock::TimeOffset& offset);

/// The offset, and a table of ATE (m), RPE over 1 s (m, deg) and undetected failures with the stamps as read
/// and with the offset. Ends with a newline.
[[nodiscard]] std::string clock_text(const reference_clock::ReferenceClock& clock);

}  // namespace fusebench::metric_reports
