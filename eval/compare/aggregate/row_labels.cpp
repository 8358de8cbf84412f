#include <utility>

#include "eval/compare/aggregate/run_rows.hpp"
#include "eval/record/run_files/run_set.hpp"

namespace fusebench::aggregate {

void set_labels(std::vector<RunRow>& rows) {
  const run_files::RunSet set(std::vector<run_files::RunIdentity>(rows.begin(), rows.end()));
  std::vector<std::string> labels = set.labels();
  std::vector<std::string> windows = set.window_labels();
  std::vector<std::string> imus = set.imus();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].label = std::move(labels[i]);
    rows[i].window = std::move(windows[i]);
    rows[i].imu = std::move(imus[i]);
  }
}

}  // namespace fusebench::aggregate
