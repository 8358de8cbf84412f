#include "eval/report/run_charts/profile_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "eval/record/profile/run_profile.hpp"

namespace fusebench::run_charts {

namespace {

using NamedHistogram = std::pair<std::string, record::DurationHistogram>;

/// The share of the frames in each bin, above its middle; the bins beside the first and the last are empty.
std::vector<Vector2d> shares(const record::DurationHistogram& histogram) {
  const std::vector<double>& edges_ms = histogram.edges_ms;
  std::vector<Vector2d> points;
  for (std::size_t bin = 0; bin < histogram.counts.size() && bin + 1 < edges_ms.size(); ++bin) {
    const double share = static_cast<double>(histogram.counts[bin]) / static_cast<double>(histogram.count);
    points.emplace_back(std::sqrt(edges_ms[bin] * edges_ms[bin + 1]), 100 * share);
  }
  if (points.empty()) return points;
  constexpr double kBinWidth = 1.2589;  // ten a decade
  points.insert(points.begin(), {points.front().x() / kBinWidth, 0});
  points.emplace_back(points.back().x() * kBinWidth, 0);
  return points;
}

std::string sentence_of(const std::vector<NamedHistogram>& histograms) {
  const auto whole = std::ranges::find(histograms, profile::kFrameName, &NamedHistogram::first);
  if (whole == histograms.end()) return "";
  const record::DurationHistogram& frame = whole->second;
  std::string text = fmt::format(
      "Of {} frame{}, half took {:.3g} ms or less, one in ten {:.3g} ms or more, the slowest {:.3g} ms.",
      frame.count, frame.count == 1 ? "" : "s", frame.median_ms, frame.p90_ms, frame.max_ms);
  const NamedHistogram* largest = nullptr;
  for (const NamedHistogram& stage : histograms) {
    const bool larger = largest == nullptr || stage.second.median_ms > largest->second.median_ms;
    if (stage.first != profile::kFrameName && larger) largest = &stage;
  }
  if (largest != nullptr) {
    text += fmt::format(
        " The stage that takes most is {}: {:.3g} ms at the median, {:.3g} ms or more in one frame of ten.",
        largest->first, largest->second.median_ms, largest->second.p90_ms);
  }
  return text;
}

page::Chart profile_chart(const RunSeries& run) {
  const std::vector<NamedHistogram>& histograms = run.run->record.timing.histograms;
  page::Chart chart;
  chart.title = fmt::format("Time of the stages over the frames: {}", run.label);
  chart.caption = sentence_of(histograms);
  chart.x_label = "time in a frame [ms]";
  chart.left_label = "share of frames [%]";
  chart.log_x = true;
  for (std::size_t i = 0; i < histograms.size(); ++i)
    chart.series.push_back(
        {histograms[i].first, shares(histograms[i].second), page::SeriesStyle::line, false, i});
  return chart;
}

}  // namespace

std::vector<page::Chart> profile_charts(std::span<const RunSeries> runs) {
  std::vector<page::Chart> charts;
  for (const RunSeries& run : runs) {
    if (!run.run->record.timing.histograms.empty()) charts.push_back(profile_chart(run));
  }
  return charts;
}

}  // namespace fusebench::run_charts
