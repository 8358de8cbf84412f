#include "eval/report/metric_reports/results_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fusebench::metric_reports {

namespace {

/// Empty where titles differ.
std::string common_title(const std::vector<evo_results::LabelledResult>& results) {
  const std::string& title = results.front().result.title;
  const bool common = std::ranges::all_of(
      results, [&](const evo_results::LabelledResult& entry) { return entry.result.title == title; });
  return common ? on_one_line(title) : "";
}

std::string curves_panel(const std::vector<evo_results::LabelledResult>& results) {
  const bool timed = std::ranges::all_of(results, [](const evo_results::LabelledResult& entry) {
    const evo_results::NpyArray* const seconds = entry.result.array("seconds_from_start");
    return seconds != nullptr && seconds->values.size() == entry.result.array("error_array")->values.size();
  });
  std::string script;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::vector<double>& errors = results[i].result.array("error_array")->values;
    script += curve_block(
        fmt::format("errors{}", i),
        timed ? results[i].result.array("seconds_from_start")->values : indices(errors.size()), errors);
  }
  script += placed({0, 0.5, 1, 0.49});
  script += fmt::format(
      "set title {}\nset xlabel {}\nset ylabel {}\nset yrange [0:*]\nset key above Left reverse samplen "
      "2.5\nplot ",
      page::gnuplot_text(common_title(results)), timed ? "'time since the first pose [s]'" : "'index'",
      page::gnuplot_text(results.front().result.label));
  for (std::size_t i = 0; i < results.size(); ++i)
    script += fmt::format("{}$errors{} with lines lw 1.4 lc rgb '{}' title {}", i > 0 ? ", " : "", i,
                          page::figure_colour(i), page::gnuplot_text(results[i].label));
  return script + "\n";
}

std::string bars_panel(const std::vector<evo_results::LabelledResult>& results) {
  std::string script = "$bars << END\n";
  for (const char* name : {"rmse", "mean", "median", "std", "min", "max"}) {
    script += name;
    for (const evo_results::LabelledResult& entry : results) {
      const double value = statistic(entry.result, name);
      script += std::isfinite(value) ? fmt::format(" {:.8g}", value) : " ?";
    }
    script += '\n';
  }
  script += "END\n";
  script += kNextPanel;
  script += placed({0, 0, 1, 0.49});
  script += fmt::format(
      "set datafile missing '?'\nset xlabel ''\nset ylabel {}\nset yrange [0:*]\nset style data "
      "histograms\nset style histogram "
      "clustered gap 1.5\nset style fill solid 0.85\nset key above Left reverse samplen 2.5\nplot ",
      page::gnuplot_text(results.front().result.label));
  for (std::size_t i = 0; i < results.size(); ++i)
    script +=
        fmt::format("{}$bars using {}{} lc rgb '{}' title {}", i > 0 ? ", " : "", i + 2,
                    i == 0 ? ":xtic(1)" : "", page::figure_colour(i), page::gnuplot_text(results[i].label));
  return script + "\n";
}

}  // namespace

std::string plot_script(const std::vector<evo_results::LabelledResult>& results, const PlotFile& file) {
  return plot_begin(file, 900, 1000) + curves_panel(results) + bars_panel(results) + std::string(kPlotEnd);
}

}  // namespace fusebench::metric_reports
