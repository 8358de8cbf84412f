#include "core/estimator/acceptance/update_tests.hpp"

#include <fmt/format.h>

#include "core/base/geometry.hpp"
#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench::acceptance {

namespace {

std::optional<double> contradicting_share(const health::FrameReport& report) {
  if (report.patches_tracked == 0) return std::nullopt;
  return static_cast<double>(report.patches_contradicting) / report.patches_tracked;
}

}  // namespace

std::array<AcceptanceTest, 5> update_tests(const health::FrameReport& report,
                                           const config::TermsConfig& terms, const config::IekfConfig& iekf,
                                           const config::HealthConfig& health) {
  return {{
      {"usable patches", report.patches_accepted, Bound::at_least, static_cast<double>(iekf.min_patches),
       "iekf.min_patches"},
      // Limits the pose uncertainty against the model: a frame with a larger one would be fused
      // inconsistently.
      {"rotation sigma (degrees)", degrees(report.certainty.rotation_sigma_rad), Bound::at_most,
       health.max_rotation_sigma_deg, "health.max_rotation_sigma_deg"},
      {"position sigma (metres)", report.certainty.position_sigma_m, Bound::at_most,
       health.max_position_sigma_m, "health.max_position_sigma_m"},
      {"share of the tracked patches whose intensities do not fit", contradicting_share(report),
       Bound::at_most, 0.5, ""},
      {"median correlation of the tracked patches",
       terms.photometric_weight > 0 ? report.correlation : std::nullopt, Bound::at_least,
       health.min_correlation, "health.min_correlation"},
  }};
}

std::string rejection_reason(const health::FrameReport& report, const config::TermsConfig& terms,
                             const config::IekfConfig& iekf, const config::HealthConfig& health) {
  const std::string failure = first_failure(update_tests(report, terms, iekf, health));
  return failure.empty() ? failure : fmt::format("{}: {}", to_string(report.health), failure);
}

}  // namespace fusebench::acceptance
