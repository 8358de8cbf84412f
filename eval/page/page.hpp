// A page of tables, charts and images in one HTML file that needs no network.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/image.hpp"
#include "core/base/types.hpp"

namespace fusebench::page {

/// Columns of numbers are right-aligned: those whose cells are all numbers, "-" or empty. A cell may have
/// several lines ("\n").
struct PageTable {
  struct Row {
    std::vector<std::string> cells;
    std::string style;                   ///< "error", "warning", "note" or empty
    std::vector<std::size_t> best = {};  ///< places of the cells that are the best of their kind
    bool fixed = false;                  ///< stays at its place when the table is sorted: a mean, a sum
    /// Files beside the page that the first lines of cells lead to, one a cell, with letters, digits and -_.
    /// alone; empty, and of the cells beyond them: none.
    std::vector<std::string> links = {};
  };
  std::vector<std::string> header;
  std::vector<Row> rows;
  bool sortable = false;  ///< by a click on a heading; needs the script
};

/// How many colours the style has for series: --series-0 and so on. They repeat.
inline constexpr std::size_t kSeriesColours = 12;

enum class SeriesStyle {
  line,
  backdrop,  ///< a wide line beneath the others
  band,      ///< the area from zero to the points, beneath all lines
  dots,
  bars,
  boxes,
  segments,  ///< thin lines: from the first point to the second, from the third to the fourth, ...
};

/// What a box of a box plot shows; whiskers reach the extremes.
struct ChartBox {
  double x = 0;
  double min = 0;
  double quartile = 0;
  double median = 0;
  double upper_quartile = 0;
  double max = 0;
};

struct ChartSeries {
  std::string label;  ///< with the unit if the axes' labels do not tell
  std::vector<Vector2d> points;
  SeriesStyle style = SeriesStyle::line;
  bool right = false;                      ///< belongs to the axis on the right
  std::optional<std::size_t> colour = {};  ///< of the style's; by default the series' place in its chart
  std::vector<ChartBox> boxes = {};        ///< with SeriesStyle::boxes, in place of points
  bool on_request = false;                 ///< drawn after a click on its name; not in figures
  std::vector<double> values = {};         ///< one a point: colours the line, by ValueColours of the chart
};

/// The colour bar of a chart whose lines are coloured by their values: from zero to `top`, beyond which all
/// have the last colour.
struct ValueColours {
  std::string label;  ///< "position error [cm]"
  double top = 1;
};

struct Chart {
  std::string title;
  std::string caption;
  std::string x_label;
  std::string left_label;
  std::string right_label;                   ///< empty: no axis on the right
  bool from_zero = true;                     ///< axes of values begin at zero
  bool equal_scale = false;                  ///< a metre is as long on either axis
  bool log_x = false;                        ///< x is positive, and its axis logarithmic
  std::vector<std::string> categories = {};  ///< of x, which are then 0, 1, ...: bars stand on one another
  std::vector<std::string> x_names = {};     ///< of the places 1, 2, ... of x, in place of its numbers
  /// What is drawn at first, least and most; what lies beyond is cut and marked, and shown on request. All
  /// where there is none.
  std::optional<Vector2d> x_range = {};
  std::optional<Vector2d> y_range = {};  ///< of the axis on the left
  std::optional<ValueColours> value_colours = {};
  std::vector<ChartSeries> series;
};

struct PageImage {
  std::string caption;
  std::string data_uri;
  std::optional<double> time_s = {};  ///< of what it shows, on the charts' axis of time
};

/// A mesh or surfels, ready to be drawn: positions are quantised to 16 bits within their box.
struct SceneMesh {
  std::string label;
  PreciseMesh mesh;               ///< with colors
  std::vector<Rgb> error_colors;  ///< one a vertex, or none
  std::string picture_uri = {};   ///< in place of the mesh: on paper, and where there is no WebGL
};

/// A pose of a camera whose z points ahead and whose y points down.
struct TimedPose {
  double time_s = 0;
  SE3 T_scene_camera;
};

/// The path of a camera, drawn beside the mesh of that label.
struct ScenePath {
  std::string label;
  std::size_t colour = 0;
  std::vector<TimedPose> poses;
};

/// Meshes side by side, turned together. The first look is along `ahead`, from where all of the box is in
/// view.
struct PageScene {
  std::string caption;
  std::vector<SceneMesh> meshes;
  std::vector<ScenePath> paths = {};
  double largest_error_m = 0;        ///< of the last colour
  Vector3d low = Vector3d::Zero();   ///< corner of the box that should be in view
  Vector3d high = Vector3d::Zero();  ///< the corner across
  std::array<double, 3> up = {0, 0, 1};
  std::array<double, 3> ahead = {0, 1, 0};
};

/// What a reader should know first, a paragraph a line.
struct PageParagraphs {
  std::vector<std::string> lines;
};

/// Text that is folded away until it is requested.
struct PageDetails {
  std::string summary;
  PageTable table;
};

struct PageSection {
  std::string title;
  std::string text;
  std::variant<PageTable, std::vector<Chart>, std::vector<PageImage>, PageScene, std::vector<PageDetails>,
               PageParagraphs>
      content;
  int level = 2;  ///< of the heading; level 2 stands in the page's list of contents, and begins a part
  /// Closed until its heading is clicked, and open on paper. Of level 2: with all of its part.
  bool folded = false;
  std::size_t image_columns = 0;  ///< of images where there is room; 0: as many as fit
  bool strip = false;             ///< images in one row, small, to scroll through
  bool timeline = false;          ///< of a part: one time for all of its charts, images and cameras
};

struct Page {
  std::string title;
  std::string subtitle;
  std::vector<PageSection> sections;
};

/// The whole file. Texts are escaped; numbers are written with six digits. The style follows the reader's
/// light or dark scheme.
[[nodiscard]] std::string to_html(const Page& page);

/// At most 2 * buckets points: of each of the equal stretches of x the lowest and the highest, so that peaks
/// stay.
[[nodiscard]] std::vector<Vector2d> thinned(const std::vector<Vector2d>& points, std::size_t buckets);

}  // namespace fusebench::page
