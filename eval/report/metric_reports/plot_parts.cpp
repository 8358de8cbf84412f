#include "eval/report/metric_reports/plot_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "eval/page/page.hpp"

namespace fusebench::metric_reports {

namespace {

constexpr std::size_t kMostPoints = 4000;  // of a curve: more are not distinguishable, and files grow

/// 1, 2 or 5 times a power of ten: about so many ticks over a length.
double tick_step(double length, double ticks) {
  const double decade = std::pow(10.0, std::floor(std::log10(length / ticks)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade * ticks >= length) return digit * decade;
  }
  return 10 * decade;
}

}  // namespace

PlotMode plot_mode(std::string_view name) {
  PlotMode mode;
  mode.axes.clear();
  for (const char letter : name) mode.axes.push_back(letter - 'x');
  check(mode.axes.size() == 2 || mode.axes.size() == 3, "one of the names of views");
  return mode;
}

Result<PlotFile> plot_file(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  PlotFile result{file.has_parent_path() ? file.parent_path() : ".", file.stem().string()};
  if (ending == ".svg" || ending == ".pdf") {
    result.format = ending == ".pdf" ? page::FigureFormat::pdf : page::FigureFormat::svg;
    return result;
  }
  return fail(ErrorCode::usage, fmt::format("{}: plots are drawn as .svg or .pdf", file.string()),
              "a browser, Inkscape or rsvg-convert makes a PNG of an SVG");
}

Result<void> draw(const std::string& script, const PlotFile& file) {
  return page::draw_figure(script, file.folder, file.name, file.format);
}

std::string plot_begin(const PlotFile& file, int width_px, int height_px) {
  const std::string terminal =
      file.format == page::FigureFormat::pdf
          ? fmt::format("set terminal pdfcairo noenhanced size {:.1f}cm,{:.1f}cm font \"Helvetica,9\"\n",
                        width_px / 50.0, height_px / 50.0)
          : fmt::format(
                "set terminal svg noenhanced size {},{} dynamic font \"Helvetica,13\" background '#ffffff'\n",
                width_px, height_px);
  return terminal + "set output " + page::gnuplot_text(page::figure_file(file.name, file.format)) +
         "\nset multiplot\nset grid lc rgb '#d8dde2'\nset tics nomirror\n";
}

std::string placed(const Place& place) {
  return fmt::format("set origin {:.4g},{:.4g}\nset size {:.4g},{:.4g}\n", place.left, place.bottom,
                     place.width, place.height);
}

std::vector<std::size_t> strided(std::size_t size) {
  const std::size_t step = std::max<std::size_t>(1, (size + kMostPoints - 1) / kMostPoints);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < size; i += step) kept.push_back(i);
  if (!kept.empty() && kept.back() + 1 != size) kept.push_back(size - 1);
  return kept;
}

std::string curve_block(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) points.emplace_back(x[i], y[i]);
  std::string text = fmt::format("${} << END\n", name);
  for (const Vector2d& p : page::thinned(points, kMostPoints / 2))
    fmt::format_to(std::back_inserter(text), "{:.8g} {:.8g}\n", p.x(), p.y());
  return text + "END\n";
}

std::string position_block(const std::string& name, const Trajectory& poses, const PlotMode& mode) {
  std::string text = fmt::format("${} << END\n", name);
  for (const std::size_t i : strided(poses.size())) {
    for (const int axis : mode.axes)
      fmt::format_to(std::back_inserter(text), "{:.7g} ", poses[i].T_world_camera.translation[axis]);
    text += '\n';
  }
  return text + "END\n";
}

std::string view_axes(const PlotMode& mode, const std::vector<const Trajectory*>& drawn, double zoom) {
  std::string text;
  constexpr std::array<char, 3> kOfPlot = {'x', 'y', 'z'};
  const bool plane = mode.plane();
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Trajectory* poses : drawn) {
    for (const StampedPose& pose : *poses) {
      for (std::size_t k = 0; k < mode.axes.size(); ++k) {
        low[k] = std::min(low[k], pose.T_world_camera.translation[mode.axes[k]]);
        high[k] = std::max(high[k], pose.T_world_camera.translation[mode.axes[k]]);
      }
    }
  }
  double longest = 1e-6;
  for (std::size_t k = 0; k < mode.axes.size(); ++k) longest = std::max(longest, high[k] - low[k]);
  const double step = tick_step(longest, 8);
  for (std::size_t k = 0; k < mode.axes.size(); ++k) {
    const double half = 0.53 * std::max(high[k] - low[k], (plane ? 0.6 : 0.5) * longest);
    const double centre = 0.5 * (low[k] + high[k]);
    text += fmt::format("set {0}range [{1:.6g}:{2:.6g}]\nset {0}tics {3:.6g}\nset {0}label {4}\n", kOfPlot[k],
                        centre - half, centre + half, step,
                        page::gnuplot_text(fmt::format("{} [m]", static_cast<char>('x' + mode.axes[k]))));
  }
  if (plane) return text + "set size ratio -1\n";
  return text +
         fmt::format(
             "set view 58,35,{}\nset view equal xyz\nset xyplane relative 0\nset zlabel rotate by 90\n",
             zoom);
}

std::vector<double> indices(std::size_t size) {
  std::vector<double> values(size);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

double statistic(const evo_results::EvoResult& result, std::string_view name) {
  const auto found = std::ranges::find(result.stats, name, [](const auto& entry) { return entry.first; });
  return found == result.stats.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string on_one_line(std::string title) {
  std::ranges::replace(title, '\n', ' ');
  return title;
}

}  // namespace fusebench::metric_reports
