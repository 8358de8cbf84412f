// Failures by angular speed, of all recordings of a page together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_series.hpp"
#include "eval/trajectory_error/failures_by_speed.hpp"

namespace fusebench::report {

/// Collects runs by method, in the order in which methods come.
class SpeedFailures {
 public:
  /// What the run's poses were when each frame came, and, if the system revised them, at the end.
  void add(const RunSeries& run, const std::string& method);

  /// A chart and a table; none where no camera turned by 100 deg/s or nothing failed.
  [[nodiscard]] std::vector<page::PageSection> sections() const;

 private:
  struct Method {
    std::string name;
    std::size_t colour;
    std::vector<trajectory_error::SpeedBin> bins;
  };

  void add(const std::string& name, std::size_t colour, const std::vector<trajectory_error::SpeedBin>& bins);

  std::vector<Method> methods_;
};

}  // namespace fusebench::report
