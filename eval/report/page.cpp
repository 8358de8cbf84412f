#include "eval/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text_table.hpp"
#include "eval/json_text.hpp"
#include "eval/report/page_assets.hpp"

namespace fusebench {

namespace {

using Json = nlohmann::ordered_json;

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Six digits say what a chart can show, and halve the file.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return parse_number(fmt::format("{:.6g}", value)).value_or(value);
}

std::string_view style_name(SeriesStyle style) {
  switch (style) {
    case SeriesStyle::dots:
      return "dots";
    case SeriesStyle::bars:
      return "bars";
    case SeriesStyle::line:
      break;
  }
  return "line";
}

Json json_of(const Chart& chart) {
  Json series = Json::array();
  for (std::size_t place = 0; place < chart.series.size(); ++place) {
    const ChartSeries& s = chart.series[place];
    Json points = Json::array();
    for (const Vector2d& point : s.points) points.push_back({number(point.x()), number(point.y())});
    series.push_back({{"label", s.label},
                      {"style", style_name(s.style)},
                      {"colour", s.colour.value_or(place)},
                      {"right", s.right},
                      {"points", points}});
  }
  return {{"x", chart.x_label},
          {"left", chart.left_label},
          {"right", chart.right_label},
          {"zero", chart.from_zero},
          {"series", series}};
}

std::string html_of(const PageTable& table) {
  std::string html = "<div class=\"scroll\"><table>\n";
  if (!table.header.empty()) {
    html += "<tr>";
    for (const std::string& cell : table.header) html += fmt::format("<th>{}</th>", escaped(cell));
    html += "</tr>\n";
  }
  for (const PageTable::Row& row : table.rows) {
    html += row.style.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", row.style);
    for (const std::string& cell : row.cells) html += fmt::format("<td>{}</td>", escaped(cell));
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string html_of(const std::vector<Chart>& charts, Json& all) {
  std::string html = "<div class=\"charts\">\n";
  for (const Chart& chart : charts) {
    html += fmt::format(
        "<figure><h3>{}</h3><div class=\"canvas\"><canvas id=\"chart-{}\" role=\"img\" "
        "aria-label=\"{}\"></canvas></div><figcaption>{}</figcaption></figure>\n",
        escaped(chart.title), all.size(), escaped(chart.title), escaped(chart.caption));
    all.push_back(json_of(chart));
  }
  return html + "</div>\n";
}

std::string html_of(const std::vector<PageImage>& images) {
  std::string html = "<div class=\"images\">\n";
  for (const PageImage& image : images) {
    html += fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n",
                        escaped(image.caption), image.data_uri);
  }
  return html + "</div>\n";
}

std::string html_of(const PageSection& section, Json& charts) {
  std::string html = fmt::format("<h2>{}</h2>\n", escaped(section.title));
  if (!section.text.empty()) html += fmt::format("<p>{}</p>\n", escaped(section.text));
  if (const auto* table = std::get_if<PageTable>(&section.content)) return html + html_of(*table);
  if (const auto* list = std::get_if<std::vector<Chart>>(&section.content))
    return html + html_of(*list, charts);
  return html + html_of(std::get<std::vector<PageImage>>(section.content));
}

/// JSON that cannot end the script element that holds it.
std::string script_safe(const Json& json) {
  std::string safe;
  for (const char c : json_text(json, -1)) {
    if (c == '/' && !safe.empty() && safe.back() == '<') safe += '\\';
    safe += c;
  }
  return safe;
}

}  // namespace

std::string to_html(const Page& page) {
  Json charts = Json::array();
  std::string body;
  for (const PageSection& section : page.sections) body += html_of(section, charts);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>\n{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p>{1}</p>\n"
      "<noscript><p>The charts need JavaScript; everything else is here.</p></noscript>\n{3}"
      "<script type=\"application/json\" id=\"charts\">{4}</script>\n"
      "<script>{5}</script>\n<script>\n{6}</script>\n</body>\n</html>\n",
      escaped(page.title), escaped(page.subtitle), page_style(), body, script_safe(charts), chart_library(),
      page_script());
}

std::vector<Vector2d> thinned(const std::vector<Vector2d>& points, std::size_t buckets) {
  if (points.size() <= 2 * buckets) return points;
  std::vector<Vector2d> result;
  for (std::size_t b = 0; b < buckets; ++b) {
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(b * points.size() / buckets);
    const auto end = points.begin() + static_cast<std::ptrdiff_t>((b + 1) * points.size() / buckets);
    auto [low, high] =
        std::minmax_element(begin, end, [](const Vector2d& p, const Vector2d& q) { return p.y() < q.y(); });
    if (high < low) std::swap(low, high);
    result.push_back(*low);
    if (low != high) result.push_back(*high);
  }
  return result;
}

}  // namespace fusebench
