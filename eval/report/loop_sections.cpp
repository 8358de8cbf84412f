#include "eval/report/loop_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/geometry.hpp"
#include "eval/compare/tables/systems_table.hpp"
#include "eval/metrics/loop_error/loop_metrics.hpp"
#include "eval/report/run_charts/chart_parts.hpp"
#include "eval/report/run_charts/loop_charts.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::report {

namespace {

constexpr std::size_t kMostCharted = 4;  // runs of a recording

using run_files::CandidateFate;
using run_files::CandidateRow;

std::string mode_of(const record::RunRecord& record) {
  const auto option =
      std::ranges::find(record.config, std::string_view("loops.mode"), &record::RecordedOption::key);
  const auto* mode = option == record.config.end() ? nullptr : std::get_if<std::string>(&option->value);
  if (mode == nullptr) return "-";
  return tables::is_of_another_system(record) ? "its own" : *mode;
}

std::string ate_cell(const record::Outcome<trajectory_error::AteResult>& ate) {
  return text::number_cell(ate.value ? std::optional(ate.value->stats.rmse) : std::nullopt,
                           run_charts::kCentimetres, 2);
}

std::string found_cell(const loop_error::Revisits& revisits) {
  return fmt::format("{} of {}", revisits.found, revisits.count);
}

/// Cells of what only a truth can tell.
std::vector<std::string> error_cells(const record::RunRecord& record) {
  if (!record.loops || !record.loops->value) return {"-", "-", "-", "-", "-"};
  const loop_error::LoopError& error = *record.loops->value;
  std::vector<std::string> cells = {found_cell(error.sharp), found_cell(error.blurred),
                                    fmt::format("{}", error.false_accepted), "-", "-"};
  if (error.accepted == 0) return cells;
  cells[3] = fmt::format("{:.2f} cm, {:.2f} deg", run_charts::kCentimetres * error.median_translation_m,
                         degrees(error.median_rotation_rad));
  cells[4] = fmt::format("{:.2f}, {:.2f}", error.nees_position, error.nees_rotation);
  return cells;
}

page::PageTable::Row row_of(const run_charts::RunSeries& run) {
  const record::RunRecord& record = run.run->record;
  page::PageTable::Row row;
  const auto count = [&](CandidateFate fate) {
    return std::ranges::count(run.candidates, fate, &CandidateRow::fate);
  };
  row.cells = {run.label, mode_of(record)};
  if (run.places.empty()) {
    row.cells.insert(row.cells.end(), 4, "-");
  } else {
    row.cells.push_back(fmt::format("{}", run.places.size()));
    row.cells.push_back(fmt::format("{}", run.candidates.size()));
    row.cells.push_back(fmt::format("{}, {}, {}", count(CandidateFate::accepted_by_features),
                                    count(CandidateFate::accepted_by_depth),
                                    count(CandidateFate::accepted_by_tracker)));
    row.cells.push_back(fmt::format("{}, {}, {}", count(CandidateFate::no_pose),
                                    count(CandidateFate::depth_differs), count(CandidateFate::poses_differ)));
  }
  auto errors = error_cells(record);
  row.cells.insert(row.cells.end(), std::make_move_iterator(errors.begin()),
                   std::make_move_iterator(errors.end()));
  row.cells.push_back(ate_cell(record.metrics.ate));
  row.cells.push_back(record.final_metrics ? ate_cell(record.final_metrics->ate) : "-");
  const bool known = record.loops && record.loops->value;
  row.cells.push_back(text::number_cell(known ? record.loops->value->oracle_ate_m : std::nullopt,
                                        run_charts::kCentimetres, 2));
  if (known && record.loops->value->false_accepted > 0) row.style = "warning";
  return row;
}

std::string explanation() {
  return fmt::format(
      "Places are frames that are kept to be recognised; a candidate is a pair of places that look "
      "alike or see the same by the poses so far, and a loop is an accepted candidate. Online: each pose as "
      "estimated when its frame was processed; final: as estimated at the end. Mode \"its own\": the system "
      "closes loops by its method, and "
      "keeps no list of them. Returns: places that see {:.0f} % or more of what an older "
      "place saw, by the ground truth, and how many of them have a loop; blurred are those with more "
      "than {:.0f} px of motion blur. False: loops that are off by more than {:.0f} cm or {:.0f} "
      "degrees, and by more than {:.0f} of their own standard deviations. NEES: squared error of "
      "loops, normalised by their covariance and divided by the number of axes; 1 is consistent. ATE with "
      "true loops: of the final poses if "
      "every return had a true loop.",
      100 * loop_error::kRevisitOverlap, loop_error::kBlurred_px,
      run_charts::kCentimetres * loop_error::kFalseTranslation_m, degrees(loop_error::kFalseRotation_rad),
      loop_error::kFalseSigmas);
}

page::PageSection table_section(std::span<const run_charts::RunSeries* const> runs) {
  page::PageTable table;
  table.header = {"run",
                  "loops.mode",
                  "places",
                  "candidates",
                  "loops: by features, by depth alone, by the tracker",
                  "refused: no certain pose, depth does not fit, contradicts the poses",
                  "returns found, sharp",
                  "returns found, blurred",
                  "false loops",
                  "error of loops, median",
                  "NEES of loops: position, rotation",
                  "ATE online [cm]",
                  "ATE final [cm]",
                  "ATE with true loops [cm]"};
  std::string text = explanation();
  for (const run_charts::RunSeries* const run : runs) {
    table.rows.push_back(row_of(*run));
    const auto& loops = run->run->record.loops;
    if (loops && !loops->value)
      text += fmt::format(" {}: no errors of loops: {}.", run->label, loops->reason);
  }
  return {"Loops and final poses", std::move(text), std::move(table), 3};
}

}  // namespace

std::vector<page::PageSection> loop_sections(std::span<const run_charts::RunSeries> runs,
                                             std::size_t buckets) {
  std::vector<const run_charts::RunSeries*> with_loops;
  for (const run_charts::RunSeries& run : runs) {
    if (has_loops(run)) with_loops.push_back(&run);
  }
  if (with_loops.empty()) return {};
  std::vector<page::PageSection> sections = {table_section(with_loops)};
  std::string text =
      "A line leads from a place to the frame that was compared with it; it is short where the camera "
      "came back to the same spot. Candidates that were refused, those that contradict the poses and "
      "the others, are drawn after a click on their name, which is struck out until then.";
  if (with_loops.size() > kMostCharted) {
    text += fmt::format(" Of the {} runs, the first {} are drawn.", with_loops.size(), kMostCharted);
    with_loops.resize(kMostCharted);
  }
  std::vector<page::Chart> views, times;
  for (const run_charts::RunSeries* const run : with_loops) {
    for (page::Chart& chart : run_charts::loop_view_charts(*run, buckets)) views.push_back(std::move(chart));
    for (page::Chart& chart : run_charts::loop_time_charts(*run, buckets)) times.push_back(std::move(chart));
  }
  if (!views.empty()) sections.push_back({"Trajectories with loops", std::move(text), std::move(views), 3});
  if (!times.empty()) sections.push_back({"Loops over time", "", std::move(times), 3});
  return sections;
}

}  // namespace fusebench::report
