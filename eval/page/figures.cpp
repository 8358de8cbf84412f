#include "eval/page/figures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <iterator>
#include <set>
#include <thread>

#include "core/base/io/fingerprint.hpp"
#include "core/base/io/temporary_mark.hpp"
#include "eval/record/process/child_processes.hpp"
#include "eval/text/control_characters.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::page {

namespace {

// Those of pages, in light.
constexpr std::array<const char*, kSeriesColours> kColours = {"#0067a8", "#c8500a", "#00795a", "#a3417f",
                                                              "#6b6b00", "#6a5acd", "#8c5a3c", "#5f6973",
                                                              "#b3125c", "#3b7a1e", "#00767f", "#7b3fa0"};

/// As wide as a column of a two-column paper (8.5 cm), with letters of 8 points there.
std::string terminal(FigureFormat format, bool equal) {
  if (format == FigureFormat::pdf)
    return fmt::format("set terminal pdfcairo noenhanced size 8.5cm,{}cm font \"Helvetica,8\"\n",
                       equal ? 7.5 : 5.2);
  return fmt::format(
      "set terminal svg noenhanced size 340,{} dynamic font \"Helvetica,11\" background '#ffffff'\n",
      equal ? 300 : 210);
}

/// The range of an axis, and of both the distance of ticks. A metre is as long on either axis, so the shorter
/// one gets room for its ticks.
std::string equal_axes(const Chart& chart) {
  Eigen::AlignedBox2d box;
  for (const ChartSeries& series : chart.series) {
    for (const Vector2d& point : series.points) {
      if (point.allFinite()) box.extend(point);
    }
  }
  if (chart.x_range && chart.y_range)
    box = Eigen::AlignedBox2d(Vector2d(chart.x_range->x(), chart.y_range->x()),
                              Vector2d(chart.x_range->y(), chart.y_range->y()));
  if (box.isEmpty()) return "";
  constexpr double kMargin = 1.06;
  constexpr double kLeastShare = 0.4;
  constexpr double kTicks = 5;
  const double longest = std::max(box.sizes().maxCoeff(), 1e-6) * kMargin;
  std::string script;
  for (int axis = 0; axis < 2; ++axis) {
    const double half = 0.5 * std::max(kMargin * box.sizes()[axis], kLeastShare * longest);
    script += fmt::format("set {}range [{:.6g}:{:.6g}]\n", axis == 0 ? 'x' : 'y', box.center()[axis] - half,
                          box.center()[axis] + half);
  }
  const double decade = std::pow(10.0, std::floor(std::log10(longest / kTicks)));
  double step = 10 * decade;
  for (const double digit : {5.0, 2.0, 1.0}) {
    if (digit * decade * kTicks >= longest) step = digit * decade;
  }
  return script + fmt::format("set xtics {0:.6g}\nset ytics {0:.6g}\nset size ratio -1\n", step);
}

/// Of lines, so that they can be told apart in print as well, and where they cover each other.
std::string dashes(std::size_t place) {
  constexpr std::array<const char*, 4> kDashes = {"", " dt (8,4)", " dt (3,3)", " dt (9,3,2,3)"};
  return kDashes[place % kDashes.size()];
}

void add_data(const Chart& chart, std::string& script) {
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const ChartSeries& series = chart.series[i];
    if (series.on_request) continue;
    auto out = std::back_inserter(script);
    fmt::format_to(out, "$series{} << END\n", i);
    const bool segments = series.style == SeriesStyle::segments;
    for (std::size_t k = 0; k < series.points.size(); ++k) {
      const Vector2d& p = series.points[k];
      const std::string value = series.values.empty() ? "" : fmt::format(" {:.6g}", series.values[k]);
      fmt::format_to(out, "{:.6g} {:.6g}{}\n{}", p.x(), p.y(), value, segments && k % 2 == 1 ? "\n" : "");
    }
    for (const ChartBox& b : series.boxes) {
      fmt::format_to(out, "{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n", b.x, b.quartile, b.min, b.max,
                     b.upper_quartile, b.median);
    }
    script += "END\n";
  }
}

/// The colour bar of lines that are coloured by their values: viridis, as on pages.
std::string value_colours(const Chart& chart) {
  if (!chart.value_colours) return "";
  return fmt::format(
      "set palette defined (0 '#440154', 1 '#3e4a89', 2 '#26828e', 3 '#35b779', 4 '#b4de2c', 5 '#fde725')\n"
      "set cbrange [0:{:.6g}]\nset cblabel {}\n",
      chart.value_colours->top, gnuplot_text(chart.value_colours->label));
}

/// Boxes at one place stand side by side.
std::string box_places(const Chart& chart, std::size_t place) {
  std::set<double> places;
  std::size_t count = 0;
  for (const ChartSeries& series : chart.series) {
    for (const ChartBox& box : series.boxes) places.insert(box.x);
    if (!series.boxes.empty()) ++count;
  }
  double gap = 1;
  for (auto at = places.begin(); at != places.end() && std::next(at) != places.end(); ++at)
    gap = at == places.begin() ? *std::next(at) - *at : std::min(gap, *std::next(at) - *at);
  const double width = 0.7 * gap / static_cast<double>(std::max<std::size_t>(count, 1));
  const double shift = (static_cast<double>(place) - 0.5 * static_cast<double>(count - 1)) * width;
  return fmt::format("using ($1+{:.6g}):2:3:4:5:({:.6g})", shift, 0.8 * width);
}

std::size_t lines_before(const Chart& chart, std::size_t i) {
  const auto end = chart.series.begin() + static_cast<std::ptrdiff_t>(i);
  return static_cast<std::size_t>(std::count_if(chart.series.begin(), end, [](const ChartSeries& series) {
    return series.style == SeriesStyle::line;
  }));
}

std::string curve(const Chart& chart, std::size_t i) {
  const ChartSeries& series = chart.series[i];
  const char* const colour = kColours[series.colour.value_or(i) % kColours.size()];
  const std::string title = gnuplot_text(series.label);
  const char* const axes = series.right ? " axes x1y2" : "";
  switch (series.style) {
    case SeriesStyle::line:
      if (!series.values.empty())
        return fmt::format("$series{} using 1:2:3 with lines lw 2 lc palette title {}", i, title);
      return fmt::format("$series{}{} with lines lw 1.4{} lc rgb '{}' title {}", i, axes,
                         dashes(lines_before(chart, i)), colour, title);
    case SeriesStyle::backdrop:
      return fmt::format("$series{}{} with lines lw 4 lc rgb '#66{}' title {}", i, axes, colour + 1, title);
    case SeriesStyle::segments:
      return fmt::format("$series{}{} with lines lw 0.6 lc rgb '{}' title {}", i, axes, colour, title);
    case SeriesStyle::band:
      return fmt::format(
          "$series{}{} with filledcurves y1=0 fs transparent solid 0.15 noborder lc rgb '{}' title {}", i,
          axes, colour, title);
    case SeriesStyle::dots:
      return fmt::format("$series{}{} with points pt 7 ps 0.3 lc rgb '{}' title {}", i, axes, colour, title);
    case SeriesStyle::bars:
      return fmt::format("$series{}{} with histeps lw 1.2 lc rgb '{}' title {}", i, axes, colour, title);
    case SeriesStyle::boxes: {
      const std::string places = box_places(chart, i);
      return fmt::format(
          "$series{0} {1} with candlesticks whiskerbars 0.5 fs solid 0.25 lc rgb '{2}' title {3}, $series{0} "
          "{4} with "
          "candlesticks lw 1.5 lc rgb '{2}' notitle",
          i, places, colour, title, std::string(places).replace(places.find("2:3:4:5"), 7, "6:6:6:6"));
    }
  }
  return "";
}

/// Categories side by side, series on one another.
std::string stacked(const Chart& chart) {
  std::string script =
      "set style data histograms\nset style histogram rowstacked\nset boxwidth 0.7\nset style fill solid "
      "0.9\n";
  script += "$table << END\n";
  for (std::size_t row = 0; row < chart.categories.size(); ++row) {
    script += gnuplot_text(chart.categories[row]);
    for (const ChartSeries& series : chart.series) {
      double value = 0;
      for (const Vector2d& p : series.points) value = p.x() == static_cast<double>(row) ? p.y() : value;
      script += fmt::format(" {:.6g}", value);
    }
    script += '\n';
  }
  script += "END\nplot ";
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    script += fmt::format(
        "{}$table using {}{} lc rgb '{}' title {}", i > 0 ? ", " : "", i + 2, i == 0 ? ":xtic(1)" : "",
        kColours[chart.series[i].colour.value_or(i) % kColours.size()], gnuplot_text(chart.series[i].label));
  }
  return script + "\n";
}

/// Names at 1, 2, ... along x, upright so that long ones have room.
std::string name_tics(const Chart& chart) {
  if (chart.x_names.empty()) return "";
  std::string tics;
  for (std::size_t i = 0; i < chart.x_names.size(); ++i)
    tics += fmt::format("{}{} {}", i > 0 ? ", " : "", gnuplot_text(chart.x_names[i]), i + 1);
  return fmt::format("set xtics rotate by 60 right ({})\nset xrange [0.5:{}.5]\n", tics,
                     chart.x_names.size());
}

/// Letters and digits, in lower case; what is between them becomes one '_'.
std::string slug(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    const auto c = static_cast<unsigned char>(letter);
    if (std::isalnum(c) != 0) {
      result += static_cast<char>(std::tolower(c));
    } else if (!result.empty() && result.back() != '_') {
      result += '_';
    }
  }
  while (result.ends_with('_')) result.pop_back();
  return result;
}

/// A name that file systems take with its extension; the digits tell long names apart that begin alike.
std::string shortened(const std::string& name) {
  constexpr std::size_t kLongest = 200;  // of 255 bytes
  constexpr std::size_t kKept = 180;
  if (name.size() <= kLongest) return name;
  return fmt::format("{}-{:016x}", name.substr(0, kKept), io::content_hash(name).xxh3);
}

Result<void> run_gnuplot(const std::filesystem::path& script) {
  // Within the folder, so that the script draws there again for whoever edits it.
  auto child = process::ChildProcess::start(
      {"/usr/bin/env", "-C", script.parent_path().string(), "gnuplot", script.filename().string()});
  if (!child) return tl::unexpected(child.error());
  std::optional<process::ChildEnd> end;
  while (!(end = child->poll())) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  if (end->exit_code == 0) return {};
  constexpr int kNotFound = 127;
  if (end->exit_code == kNotFound) {
    return fail(ErrorCode::usage, "figures are drawn by gnuplot, which is not installed",
                "Debian: apt install gnuplot-nox");
  }
  return fail(ErrorCode::internal,
              fmt::format("{}: gnuplot ended with {}: {}", script.string(), end->how(), end->errors));
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text::without_controls(text, "\n")) {
    if (c == '"' || c == '\\' || c == '`') result += '\\';  // it runs what stands between backticks
    result += c == '\n' ? ' ' : c;
  }
  return result + "\"";
}

std::string_view figure_colour(std::size_t place) { return kColours[place % kColours.size()]; }

Result<FigureFormat> parse_figure_format(std::string_view text) {
  if (text == "svg") return FigureFormat::svg;
  if (text == "pdf") return FigureFormat::pdf;
  return fail(ErrorCode::usage, fmt::format("unknown figure format '{}'", text), "formats are svg and pdf");
}

std::string gnuplot_script(const Chart& chart, const std::string& file, FigureFormat format) {
  std::string script = terminal(format, chart.equal_scale) + "set output " + gnuplot_text(file) + "\n";
  script += "set key above center Left reverse samplen 2.5\nset grid lc rgb '#d8dde2'\nset tics nomirror\n";
  script += fmt::format("set xlabel {}\nset ylabel {}\n", gnuplot_text(chart.x_label),
                        gnuplot_text(chart.left_label));
  if (!chart.right_label.empty())
    script += fmt::format("set y2label {}\nset y2tics\n", gnuplot_text(chart.right_label));
  if (chart.equal_scale) {
    script += equal_axes(chart);
    script += value_colours(chart);
  } else if (chart.y_range) {
    script += fmt::format("set yrange [{:.6g}:{:.6g}]\n", chart.y_range->x(), chart.y_range->y());
  } else if (chart.from_zero) {
    script += "set yrange [0:*]\n";
  }
  if (chart.x_range && !chart.equal_scale)
    script += fmt::format("set xrange [{:.6g}:{:.6g}]\n", chart.x_range->x(), chart.x_range->y());
  script += name_tics(chart);
  if (chart.log_x) script += "set logscale x\n";
  if (!chart.categories.empty()) return script + stacked(chart);
  add_data(chart, script);
  std::string curves;
  for (const bool bands : {true, false}) {
    for (std::size_t i = 0; i < chart.series.size(); ++i) {
      const ChartSeries& series = chart.series[i];
      if (series.on_request || (series.style == SeriesStyle::band) != bands) continue;
      curves += (curves.empty() ? "" : ", ") + curve(chart, i);
    }
  }
  return script + "plot " + curves + "\n";
}

std::string figure_file(const std::string& name, FigureFormat format) {
  return name + (format == FigureFormat::pdf ? ".pdf" : ".svg");
}

Result<void> draw_figure(const std::string& script, const std::filesystem::path& folder,
                         const std::string& name, FigureFormat format) {
  const std::filesystem::path file = folder / (name + ".gp");
  if (auto written = text::write_text_file(file, script); !written) return written;
  const std::filesystem::path figure = folder / figure_file(name, format);
  std::error_code ignored;
  const auto is = std::filesystem::symlink_status(figure, ignored).type();
  if (is == std::filesystem::file_type::symlink) std::filesystem::remove(figure, ignored);
  const io::TemporaryMark half_drawn(io::TemporaryMark::Kind::file, figure);
  auto drawn = run_gnuplot(file);
  if (!drawn) std::filesystem::remove(figure, ignored);
  return drawn;
}

std::string panels_script(const std::vector<Panel>& panels, std::size_t columns,
                          const Eigen::Vector2i& size_px, const std::string& file, FigureFormat format) {
  // Over both columns of a paper, with letters of 8 points there.
  constexpr double kWidth_cm = 17.8;
  constexpr double kLetter_cm = 8 * 2.54 / 72;
  const auto rows = static_cast<int>((panels.size() + columns - 1) / columns);
  const int width_px = static_cast<int>(columns) * (size_px.x() + 6);
  const double cm_per_px = kWidth_cm / width_px;
  const double letter_px = kLetter_cm / cm_per_px;
  const int title_px = static_cast<int>(std::lround(2.2 * letter_px));
  const int height_px = rows * (size_px.y() + title_px);
  std::string script =
      format == FigureFormat::pdf
          ? fmt::format("set terminal pdfcairo noenhanced size {:.1f}cm,{:.2f}cm font \"Helvetica,8\"\n",
                        kWidth_cm, cm_per_px * height_px)
          : fmt::format(
                "set terminal svg noenhanced size {},{} dynamic font \"Helvetica,{:.0f}\" background "
                "'#ffffff'\n",
                width_px, height_px, letter_px);
  script += "set output " + gnuplot_text(file) + "\nunset tics\nunset border\nunset key\n";
  script += fmt::format("set multiplot layout {},{} margins 0.005,0.995,0.01,{:.3f} spacing 0.01,{:.3f}\n",
                        rows, columns, 1.0 - static_cast<double>(title_px) / height_px,
                        static_cast<double>(title_px) / height_px);
  for (const Panel& panel : panels)
    script += fmt::format("set title {} offset 0,-0.4\nplot {} binary filetype=png with rgbimage notitle\n",
                          gnuplot_text(panel.title), gnuplot_text(panel.file));
  return script + "unset multiplot\n";
}

std::string file_name_of(std::string_view text) { return shortened(slug(text)); }

Result<std::size_t> write_figures(const Page& page, const std::filesystem::path& folder,
                                  FigureFormat format) {
  std::string part;
  std::set<std::string> names;
  for (const PageSection& section : page.sections) {
    if (section.level == 2) part = slug(section.title);
    const auto* charts = std::get_if<std::vector<Chart>>(&section.content);
    if (charts == nullptr) continue;
    for (const Chart& chart : *charts) {
      std::string name = shortened(part + "-" + slug(chart.title));
      for (int copy = 2; !names.insert(name).second; ++copy)
        name = shortened(fmt::format("{}-{}-{}", part, slug(chart.title), copy));
      const std::string script = gnuplot_script(chart, figure_file(name, format), format);
      if (auto drawn = draw_figure(script, folder, name, format); !drawn)
        return tl::unexpected(drawn.error());
    }
  }
  return names.size();
}

}  // namespace fusebench::page
