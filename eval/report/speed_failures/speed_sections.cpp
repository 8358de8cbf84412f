#include "eval/report/speed_failures/speed_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

namespace fusebench::speed_failures {

namespace {

constexpr std::size_t kFastBin = 2;  // from 100 deg/s

std::string range_text(std::size_t bin) {
  return fmt::format("{:.0f} to {:.0f} deg/s", kSpeedBin_degps * static_cast<double>(bin),
                     kSpeedBin_degps * static_cast<double>(bin + 1));
}

std::string cell_text(const SpeedBin& bin) {
  if (bin.frames == 0) return "-";
  return fmt::format("{:.0f} % of {} ({} lost, {} undetected)",
                     100.0 * static_cast<double>(bin.lost + bin.silent) / static_cast<double>(bin.frames),
                     bin.frames, bin.lost, bin.silent);
}

}  // namespace

void FailureSections::add(const std::string& name, std::size_t colour, const Trajectory& ground_truth,
                          std::span<const std::int64_t> frames_ns, const Trajectory& estimate) {
  const std::vector<SpeedBin> bins = failures_by_speed(ground_truth, frames_ns, estimate);
  auto method = std::ranges::find(methods_, name, &Method::name);
  if (method == methods_.end()) method = methods_.insert(method, {name, colour, {}});
  if (method->bins.size() < bins.size()) method->bins.resize(bins.size());
  for (std::size_t i = 0; i < bins.size(); ++i) method->bins[i] += bins[i];
}

std::vector<page::PageSection> FailureSections::sections() const {
  std::size_t most = 0;
  std::size_t failed = 0;
  for (const Method& method : methods_) {
    most = std::max(most, method.bins.size());
    for (const SpeedBin& bin : method.bins) failed += bin.lost + bin.silent;
  }
  if (most <= kFastBin || failed == 0) return {};
  page::Chart chart;
  chart.title = "Frames that are lost or undetected failures";
  chart.x_label = "angular speed of the camera [deg/s]";
  chart.left_label = "share of the frames [%]";
  page::PageTable table;
  table.header = {"method"};
  for (std::size_t i = 0; i < most; ++i) table.header.push_back(range_text(i));
  for (const Method& method : methods_) {
    page::ChartSeries series{method.name, {}, page::SeriesStyle::line, false, method.colour};
    page::PageTable::Row row{{method.name}, ""};
    for (std::size_t i = 0; i < most; ++i) {
      const SpeedBin bin = i < method.bins.size() ? method.bins[i] : SpeedBin{};
      row.cells.push_back(cell_text(bin));
      if (bin.frames > 0)
        series.points.emplace_back(
            kSpeedBin_degps * (static_cast<double>(i) + 0.5),
            100.0 * static_cast<double>(bin.lost + bin.silent) / static_cast<double>(bin.frames));
    }
    if (series.points.size() == 1) series.style = page::SeriesStyle::dots;  // one point is no line
    chart.series.push_back(std::move(series));
    table.rows.push_back(std::move(row));
  }
  const std::string text =
      "Frames of all recordings below, by the largest angular speed of the ground truth in the second "
      "before. Lost: without a pose; undetected: with a pose whose motion over that second has an error of "
      "more than 5 cm or 3 degrees. Bins with few frames are unreliable.";
  std::vector<page::Chart> charts{std::move(chart)};
  return {{"Failures by angular speed", text, std::move(charts)},
          {"The same in numbers", "", std::move(table), 3}};
}

}  // namespace fusebench::speed_failures
