#include <utility>

#include "eval/aggregate/run_rows.hpp"
#include "eval/run_files/run_labels.hpp"

namespace fusebench::aggregate {

namespace {

run_files::RunTraits traits_of(const RunRow& row) {
  run_files::RunTraits traits;
  traits.recording = row.recording;
  traits.variant = row.variant;
  traits.edits = row.options;
  traits.options_known = row.wrote_options;
  traits.first_frame = row.first_frame;
  traits.frames = row.frames;
  traits.repetition = static_cast<int>(row.repetition);
  traits.replicate = static_cast<int>(row.replicate);
  traits.imu = row.imu;
  traits.folder = row.run;
  return traits;
}

}  // namespace

void tell_apart(std::vector<RunRow>& rows) {
  std::vector<run_files::RunTraits> traits;
  traits.reserve(rows.size());
  for (const RunRow& row : rows) traits.push_back(traits_of(row));
  std::vector<std::string> labels = run_files::run_labels(traits);
  std::vector<std::string> windows = run_files::window_labels(traits);
  std::vector<std::string> imus = run_files::imus_of_methods(traits);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].label = std::move(labels[i]);
    rows[i].window = std::move(windows[i]);
    rows[i].imu = std::move(imus[i]);
  }
}

}  // namespace fusebench::aggregate
