// A page of tables, charts and images in one HTML file that needs no network.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry.hpp"

namespace fusebench {

struct PageTable {
  struct Row {
    std::vector<std::string> cells;
    std::string style;  ///< "error", "warning", "note" or empty
  };
  std::vector<std::string> header;
  std::vector<Row> rows;
};

enum class SeriesStyle { line, dots, bars };

struct ChartSeries {
  std::string label;  ///< with the unit if the axes' labels do not tell
  std::vector<Vector2d> points;
  SeriesStyle style = SeriesStyle::line;
  bool right = false;                      ///< belongs to the axis on the right
  std::optional<std::size_t> colour = {};  ///< of the style's; by default the series' place in its chart
};

struct Chart {
  std::string title;
  std::string caption;
  std::string x_label;
  std::string left_label;
  std::string right_label;  ///< empty: no axis on the right
  bool from_zero = true;    ///< axes of values begin at zero
  std::vector<ChartSeries> series;
};

struct PageImage {
  std::string caption;
  std::string data_uri;
};

struct PageSection {
  std::string title;
  std::string text;
  std::variant<PageTable, std::vector<Chart>, std::vector<PageImage>> content;
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

}  // namespace fusebench
