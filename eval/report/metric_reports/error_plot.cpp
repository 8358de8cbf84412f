#include "eval/report/metric_reports/error_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "eval/text/text_layout.hpp"

namespace fusebench::metric_reports {

namespace {

std::vector<double> abscissae(const ErrorPlot& plot, std::string& label) {
  const std::size_t size = plot.result.array("error_array")->values.size();
  const char* const name =
      plot.abscissa == PlotAbscissa::distances ? "distances_from_start" : "seconds_from_start";
  const evo_results::NpyArray* const array =
      plot.abscissa == PlotAbscissa::index ? nullptr : plot.result.array(name);
  if (array != nullptr && array->values.size() == size) {
    label = plot.abscissa == PlotAbscissa::distances ? "distance along the reference [m]"
                                                     : "time since the first pose [s]";
    return array->values;
  }
  label = "index";
  return indices(size);
}

/// Linear between the two nearest ranks, as numpy.percentile().
double percentile(std::vector<double> values, double percent) {
  std::ranges::sort(values);
  const double rank = percent / 100 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], rank - std::floor(rank));
}

std::string errors_panel(const ErrorPlot& plot) {
  const std::vector<double>& errors = plot.result.array("error_array")->values;
  std::string x_label;
  const std::vector<double> x = abscissae(plot, x_label);
  std::string script = curve_block("errors", x, errors);
  script += placed({0, 0.68, 1, 0.31});
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n",
                        page::gnuplot_text(on_one_line(plot.result.title)), page::gnuplot_text(x_label),
                        page::gnuplot_text(plot.result.label));
  script += "set key outside right center Left reverse samplen 2\nset yrange [0:*]\n";
  if (x.size() > 1 && x.back() > x.front())
    script += fmt::format("set xrange [{:.6g}:{:.6g}]\n", x.front(), x.back());
  const double mean = statistic(plot.result, "mean"), deviation = statistic(plot.result, "std");
  script += fmt::format("$band << END\n{0:.8g} {2:.8g} {3:.8g}\n{1:.8g} {2:.8g} {3:.8g}\nEND\n", x.front(),
                        x.back(), std::max(0.0, mean - deviation), mean + deviation);
  script += fmt::format(
      "plot $band using 1:2:3 with filledcurves fc rgb '#e3e9f2' title {}, "
      "$errors with lines lw 1.3 lc rgb '#777777' title {}",
      page::gnuplot_text("std " + text::seven_digits(deviation)), page::gnuplot_text(plot.result.label));
  std::size_t colour = 0;
  for (const char* name : {"rmse", "mean", "median"}) {
    const double value = statistic(plot.result, name);
    script +=
        fmt::format(", {:.8g} with lines lw 1.6 lc rgb '{}' title {}", value, page::figure_colour(colour++),
                    page::gnuplot_text(fmt::format("{} {}", name, text::seven_digits(value))));
  }
  return script + "\n";
}

/// Positions of the poses that have an error, with it.
std::string coloured_block(const ErrorPlot& plot) {
  const std::vector<double>& errors = plot.result.array("error_array")->values;
  std::string text = "$coloured << END\n";
  for (const std::size_t i : strided(errors.size())) {
    for (const int axis : plot.mode.axes)
      fmt::format_to(std::back_inserter(text), "{:.7g} ",
                     plot.estimate[plot.at[i]].T_world_camera.translation[axis]);
    fmt::format_to(std::back_inserter(text), "{:.7g}\n", errors[i]);
  }
  return text + "END\n";
}

std::string coloured_panel(const ErrorPlot& plot) {
  const std::vector<double>& errors = plot.result.array("error_array")->values;
  const bool coloured = !plot.at.empty();
  std::string script = position_block("reference", plot.reference, plot.mode);
  script += position_block("estimate", plot.estimate, plot.mode);
  if (coloured) script += coloured_block(plot);
  const double least = plot.colour_min.value_or(std::ranges::min(errors));
  double largest = plot.colour_max.value_or(std::ranges::max(errors));
  if (plot.colour_max_percentile) largest = percentile(errors, *plot.colour_max_percentile);
  script += kNextPanel;
  script += placed({0, 0, 1, 0.67}) + view_axes(plot.mode, {&plot.reference, &plot.estimate}, 1.1);
  script += "set key outside top center horizontal Left reverse samplen 2.5\n";
  script += fmt::format(
      "set palette defined (0 '#30509a', 0.35 '#21918c', 0.65 '#7ab648', 0.85 '#e0a526', 1 '#c8321e')\n"
      "set cbrange [{:.8g}:{:.8g}]\nset cblabel {}\nset colorbox {}\n",
      least, largest > least ? largest : least + std::max(1e-12, std::abs(least) * 1e-6),
      page::gnuplot_text(plot.result.label),
      plot.mode.plane() ? "default" : "user origin 0.86,0.2 size 0.03,0.3");
  const char* const use = plot.mode.columns();
  script += fmt::format("{}$reference using {} with lines {} title 'reference', ", plot.mode.command(), use,
                        kReferenceStyle);
  if (!coloured)
    return script + fmt::format("$estimate using {} with lines lw 1.6 lc rgb '{}' title 'estimate'\n", use,
                                page::figure_colour(0));
  // Errors of motions belong to their ends, which may lie apart.
  const bool each = plot.at.size() == plot.estimate.size();
  if (!each) script += fmt::format("$estimate using {} with lines lw 1 lc rgb '#b8c0c8' notitle, ", use);
  return script + fmt::format("$coloured using {}:{} with {} palette title 'estimate'\n", use,
                              plot.mode.axes.size() + 1, each ? "lines lw 2.5 lc" : "points pt 7 ps 0.6 lc");
}

}  // namespace

std::string plot_script(const ErrorPlot& plot, const PlotFile& file) {
  return plot_begin(file, 900, 1150) + errors_panel(plot) + coloured_panel(plot) + std::string(kPlotEnd);
}

}  // namespace fusebench::metric_reports
