#include "core/paper_system.hpp"

#include <utility>

namespace fusebench::core {

Result<health::FrameOutcome> PaperSystem::process(const RgbdFrame& frame) {
  auto report = estimator_.process(frame);
  if (!report) return tl::unexpected(std::move(report.error()));
  report_ = std::move(*report);
  return health::FrameOutcome(report_);
}

}  // namespace fusebench::core
