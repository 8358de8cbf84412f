// The charts of a page as files for papers, drawn by gnuplot.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/page/page.hpp"

namespace fusebench::page {

enum class FigureFormat { svg, pdf };
/// Error usage.
[[nodiscard]] Result<FigureFormat> parse_figure_format(std::string_view text);

/// A text as one of gnuplot's strings in double quotes, on one line. Nothing in it is run; that letters such
/// as '_' and '^' are shown as they are takes a terminal with `noenhanced`.
[[nodiscard]] std::string gnuplot_text(std::string_view text);
/// The colour of the series at a place, "#0067a8"; they repeat.
[[nodiscard]] std::string_view figure_colour(std::size_t place);

/// A script that draws the chart into a file, with the data within it.
[[nodiscard]] std::string gnuplot_script(const Chart& chart, const std::string& file, FigureFormat format);

/// One image of a figure of several.
struct Panel {
  std::string title;
  std::string file;  ///< name of a PNG in the folder of the figure
};

/// A script that draws images side by side, row by row, at one scale, each below its title. size_px: of one.
[[nodiscard]] std::string panels_script(const std::vector<Panel>& panels, std::size_t columns,
                                        const Eigen::Vector2i& size_px, const std::string& file,
                                        FigureFormat format);

/// Writes a script as NAME.gp into a folder and draws NAME.svg (or .pdf) by it. Errors: io; usage where
/// gnuplot is not installed.
[[nodiscard]] Result<void> draw_figure(const std::string& script, const std::filesystem::path& folder,
                                       const std::string& name, FigureFormat format);
/// A name for files: letters and digits of the text in lower case, with one '_' for what is between them. Of
/// a long one the beginning, and digits that tell it apart.
[[nodiscard]] std::string file_name_of(std::string_view text);
/// The name of the file of a figure.
[[nodiscard]] std::string figure_file(const std::string& name, FigureFormat format);

/// Writes each chart as RECORDING-TITLE.svg (or .pdf) into a folder, and beside it the script
/// RECORDING-TITLE.gp that draws it again, to be edited. Returns how many. Errors: io; usage where gnuplot is
/// not installed.
[[nodiscard]] Result<std::size_t> write_figures(const Page& page, const std::filesystem::path& folder,
                                                FigureFormat format);

}  // namespace fusebench::page
