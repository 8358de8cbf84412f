// Decides whether an update of the filter is accepted. The paper leaves this open.
#pragma once

#include <array>
#include <string>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/acceptance/acceptance_test.hpp"
#include "core/estimator/health/frame_report.hpp"

namespace fusebench::acceptance {

/// The acceptance tests of the update that the report describes, in the order of evaluation.
[[nodiscard]] std::array<AcceptanceTest, 5> update_tests(const health::FrameReport& report,
                                                         const config::TermsConfig& terms,
                                                         const config::IekfConfig& iekf,
                                                         const config::HealthConfig& health);

/// Reason of a rejection, with the diagnosis of the frame; empty if the update is accepted.
[[nodiscard]] std::string rejection_reason(const health::FrameReport& report,
                                           const config::TermsConfig& terms, const config::IekfConfig& iekf,
                                           const config::HealthConfig& health);

}  // namespace fusebench::acceptance
