// Parts of the pictures of trajectories and their errors: gnuplot scripts of one file with several panels.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/page/figures.hpp"
#include "eval/report/evo_results/evo_result.hpp"

namespace fusebench::metric_reports {

/// Axes of a view: indices of x, y, z; two of a plane, three in perspective.
struct PlotMode {
  std::vector<int> axes = {0, 1, 2};
  [[nodiscard]] bool plane() const { return axes.size() == 2; }
  /// "1:2": the columns of position_block() that are drawn.
  [[nodiscard]] const char* columns() const { return plane() ? "1:2" : "1:2:3"; }
  [[nodiscard]] const char* command() const { return plane() ? "plot " : "splot "; }
};
inline constexpr std::array<const char*, 7> kPlotModes = {"xy", "xz", "yx", "yz", "zx", "zy", "xyz"};
/// Of one of these names.
[[nodiscard]] PlotMode plot_mode(std::string_view name);

/// Where a picture goes and how it is drawn.
struct PlotFile {
  std::filesystem::path folder;
  std::string name;  ///< without its ending
  page::FigureFormat format = page::FigureFormat::svg;
};
/// By the ending. Error usage: neither .svg nor .pdf.
[[nodiscard]] Result<PlotFile> plot_file(const std::filesystem::path& file);
/// Draws what a script begun for this file draws, and keeps the script beside it as NAME.gp. Errors: io;
/// usage where gnuplot is not installed.
[[nodiscard]] Result<void> draw(const std::string& script, const PlotFile& file);

/// A script's first lines, of a picture of this size (svg: pixels), and its last.
[[nodiscard]] std::string plot_begin(const PlotFile& file, int width_px, int height_px);
inline constexpr std::string_view kPlotEnd = "unset multiplot\n";

/// A panel of the picture, in shares of its width and height from the lower left.
struct Place {
  double left = 0;
  double bottom = 0;
  double width = 1;
  double height = 1;
};
[[nodiscard]] std::string placed(const Place& place);
/// Forgets what the panel before has set.
inline constexpr std::string_view kNextPanel =
    "unset title\nset size noratio\nset autoscale\nset xtics autofreq\nset ytics autofreq\n";
inline constexpr std::string_view kReferenceStyle = "lw 1.5 dt (8,5) lc rgb '#555555'";

/// Evenly spaced indices below size, including the last: more points are not distinguishable.
[[nodiscard]] std::vector<std::size_t> strided(std::size_t size);

/// Data: the points of a curve over time, thinned so that peaks stay.
[[nodiscard]] std::string curve_block(const std::string& name, const std::vector<double>& x,
                                      const std::vector<double>& y);
/// Data: positions along the axes of a view.
[[nodiscard]] std::string position_block(const std::string& name, const Trajectory& poses,
                                         const PlotMode& mode);
/// The axes of a view of these trajectories, a metre as long on each; mode.command() follows. zoom: of a view
/// in perspective, which keeps more free around it the wider its panel is.
[[nodiscard]] std::string view_axes(const PlotMode& mode, const std::vector<const Trajectory*>& drawn,
                                    double zoom);

/// 0, 1, 2, ...
[[nodiscard]] std::vector<double> indices(std::size_t size);
/// NaN if the result has none of this name.
[[nodiscard]] double statistic(const evo_results::EvoResult& result, std::string_view name);
/// A result's title, of several lines, on one.
[[nodiscard]] std::string on_one_line(std::string title);

}  // namespace fusebench::metric_reports
