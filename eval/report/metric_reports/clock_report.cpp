#include "eval/report/metric_reports/clock_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "core/base/geometry.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::metric_reports {

namespace {

std::string shown(const std::optional<double>& value, double factor) {
  return value ? text::seven_digits(factor * *value) : "-";
}

std::string shown_count(const std::optional<std::size_t>& count) {
  return count ? fmt::format("{}", *count) : "-";
}

}  // namespace

std::string offset_text(const reference_clock::TimeOffset& offset) {
  return fmt::format("t_reference = t_estimate {} {:.5f} s, standard deviation {:.5f} s ({} motions)",
                     offset.offset_s < 0 ? '-' : '+', std::abs(offset.offset_s), offset.sigma_s,
                     offset.motions);
}

std::string clock_text(const reference_clock::ReferenceClock& clock) {
  const reference_clock::ClockedErrors& as_read = clock.as_read;
  const reference_clock::ClockedErrors& fitted = clock.fitted;
  const std::vector<std::vector<std::string>> lines = {
      {"", "stamps as read", "offset fitted"},
      {"ATE rmse [m]", shown(as_read.ate_rmse_m, 1), shown(fitted.ate_rmse_m, 1)},
      {"RPE 1 s rmse [m]", shown(as_read.rpe_1s_m, 1), shown(fitted.rpe_1s_m, 1)},
      {"RPE 1 s rmse [deg]", shown(as_read.rpe_1s_rad, kDegreesPerRadian),
       shown(fitted.rpe_1s_rad, kDegreesPerRadian)},
      {"undetected failures", shown_count(as_read.silent), shown_count(fitted.silent)}};
  return fmt::format("reference clock: {}\n\n{}", offset_text(clock.offset), text::aligned_columns(lines));
}

}  // namespace fusebench::metric_reports
