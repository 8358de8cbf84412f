// Failures by angular speed, of several runs together, ready to be drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "eval/page/page.hpp"
#include "eval/report/speed_failures/failures_by_speed.hpp"

namespace fusebench::speed_failures {

/// Collects runs by method, in the order in which methods come.
class FailureSections {
 public:
  /// frames_ns and the trajectories as for failures_by_speed(). colour: of the method's curve, of the
  /// style's.
  void add(const std::string& method, std::size_t colour, const Trajectory& ground_truth,
           std::span<const std::int64_t> frames_ns, const Trajectory& estimate);

  /// A chart and a table; none where no camera turned by 100 deg/s or nothing failed.
  [[nodiscard]] std::vector<page::PageSection> sections() const;

 private:
  struct Method {
    std::string name;
    std::size_t colour;
    std::vector<SpeedBin> bins;
  };

  std::vector<Method> methods_;
};

}  // namespace fusebench::speed_failures
