// An inspection as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "datasets/inspection/inspection.hpp"

namespace fusebench::inspection_report {

/// One measured quantity, as the text and the page show it.
struct InspectionRow {
  std::string group;     ///< "frames", "IMU", ...
  std::string quantity;  ///< "angular speed"
  std::string value;     ///< with its unit
};
[[nodiscard]] std::vector<InspectionRow> inspection_rows(const inspection::Inspection& inspection);

/// "rgbd_dataset_freiburg1_desk (tum): 573 frames, ..." in one line.
[[nodiscard]] std::string inspection_title(const inspection::Inspection& inspection);

/// Title, findings (errors first), then a table of what was measured.
[[nodiscard]] std::string to_text(const inspection::Inspection& inspection);

}  // namespace fusebench::inspection_report
