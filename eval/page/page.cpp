#include "eval/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "eval/page/drawn_data.hpp"
#include "eval/page/page_assets.hpp"
#include "eval/text/control_characters.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/markup_text.hpp"

namespace fusebench::page {

namespace {

std::string escaped(std::string_view text) {
  return text::with_entities(text::without_controls(text, "\n"), "&<>\"");
}

/// JSON that can neither end the script element that holds it nor begin another one. Control characters are
/// shown by their numbers.
std::string script_safe(const Json& json) {
  const std::string text = text::json_text(json, -1);
  std::string safe;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\';  // of the next character, which is there
    if (text[i] == '<') {
      safe += "\\u003c";
    } else if (escape && text[i + 1] == 'u') {
      safe += "\\\\u";
      ++i;
    } else {
      safe += text[i];
      if (escape) safe += text[++i];
    }
  }
  return safe;
}

/// A number, a share such as 12/34, a number with its range or uncertainty, "1 to 2", or several, one a line;
/// with a "!" behind one that is outside of its range.
bool is_number(std::string_view cell) {
  constexpr std::string_view kOthers = "0123456789.,+-/%e ()to!\n";
  return !cell.empty() && cell.find_first_of("0123456789") != std::string_view::npos &&
         cell.find_first_of("(/%e,to!") != 0 && cell.find_first_not_of(kOthers) == std::string_view::npos;
}

/// Names of the style's classes for columns of numbers: n1 is the first column.
std::string number_columns(const PageTable& table) {
  std::string classes;
  for (std::size_t column = 0; column < table.header.size(); ++column) {
    bool any = false;
    const bool all = std::ranges::all_of(table.rows, [&](const PageTable::Row& row) {
      if (column >= row.cells.size() || row.cells[column].empty()) return true;
      any = true;
      return row.cells[column] == "-" || is_number(row.cells[column]);
    });
    if (all && any) classes += fmt::format("{}n{}", classes.empty() ? "" : " ", column + 1);
  }
  return classes;
}

/// The cell, whose first line leads to the file.
std::string html_of_cell(const std::string& text, const std::string& file) {
  if (file.empty()) return escaped(text);
  const std::size_t line = std::min(text.find('\n'), text.size());
  return fmt::format("<a href=\"{}\">{}</a>{}", escaped(file), escaped(text.substr(0, line)),
                     escaped(text.substr(line)));
}

std::string html_of(const PageTable& table) {
  std::string classes = number_columns(table);
  if (table.sortable) classes += classes.empty() ? "sortable" : " sortable";
  std::string html = "<div class=\"scroll\"><table";
  html += classes.empty() ? ">\n" : fmt::format(" class=\"{}\">\n", classes);
  if (!table.header.empty()) {
    html += "<thead><tr>";
    for (const std::string& cell : table.header)
      html += fmt::format("<th scope=\"col\">{}</th>", escaped(cell));
    html += "</tr></thead>\n";
  }
  html += "<tbody>\n";
  for (const PageTable::Row& row : table.rows) {
    const std::string style = row.style + (row.fixed ? row.style.empty() ? "fixed" : " fixed" : "");
    html += style.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", style);
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const bool best = std::ranges::find(row.best, i) != row.best.end();
      html += fmt::format("<td{}>{}</td>", best ? " class=\"best\"" : "",
                          html_of_cell(row.cells[i], i < row.links.size() ? row.links[i] : ""));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string colour_bar(const Chart& chart) {
  if (!chart.value_colours) return "";
  return fmt::format(
      "<div class=\"colourbar\"><span>0</span><span class=\"ramp\"></span><span>{:.3g} and more</span>"
      "<span>{}</span></div>",
      chart.value_colours->top, escaped(chart.value_colours->label));
}

std::string html_of(const std::vector<Chart>& charts, std::size_t part, Json& all) {
  std::string html = "<div class=\"charts\">\n";
  for (const Chart& chart : charts) {
    html += fmt::format(
        "<figure><h3>{}</h3><div class=\"canvas{}\"><canvas id=\"chart-{}\" role=\"img\" "
        "aria-label=\"{}\"></canvas></div>{}<figcaption>{}</figcaption></figure>\n",
        escaped(chart.title), chart.equal_scale ? " square" : "", all.size(), escaped(chart.title),
        colour_bar(chart), escaped(chart.caption));
    all.push_back(json_of(chart, part));
  }
  return html + "</div>\n";
}

std::string html_of(const std::vector<PageImage>& images, const PageSection& section) {
  std::string html =
      section.strip ? "<div class=\"strip\" tabindex=\"0\">\n"
      : section.image_columns > 0
          ? fmt::format("<div class=\"images rows\" style=\"--columns: {}\">\n", section.image_columns)
          : "<div class=\"images\">\n";
  for (const PageImage& image : images) {
    html += image.time_s ? fmt::format("<figure data-time=\"{:.6g}\">", *image.time_s) : "<figure>";
    html += fmt::format("<img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n",
                        escaped(image.caption), image.data_uri);
  }
  return html + "</div>\n";
}

std::string html_of(const PageScene& scene, std::size_t part, Json& all) {
  std::string html = fmt::format("<div class=\"scene\" id=\"scene-{}\"><div class=\"stills\">\n", all.size());
  for (const SceneMesh& mesh : scene.meshes) {
    html += fmt::format("<figure><img alt=\"model: {0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n",
                        escaped(mesh.label), mesh.picture_uri);
  }
  html += "</div></div>\n";
  if (!scene.caption.empty()) html += fmt::format("<p>{}</p>\n", escaped(scene.caption));
  all.push_back(json_of(scene, part));
  return html;
}

std::string html_of(const std::vector<PageDetails>& list) {
  std::string html;
  for (const PageDetails& details : list) {
    html += fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(details.summary),
                        html_of(details.table));
  }
  return html;
}

std::string html_of(const PageParagraphs& paragraphs) {
  std::string html = "<div class=\"paragraphs\">\n";
  for (const std::string& line : paragraphs.lines) html += fmt::format("<p>{}</p>\n", escaped(line));
  return html + "</div>\n";
}

/// What the script draws.
struct Drawn {
  Json charts = Json::array();
  Json scenes = Json::array();
};

std::string heading_of(const PageSection& section, std::size_t place) {
  const std::string heading =
      fmt::format("<h{0} id=\"section-{1}\">{2}</h{0}>\n", section.level, place, escaped(section.title));
  return section.folded ? "<details class=\"fold\"><summary>" + heading + "</summary>\n" : heading;
}

/// What is below a heading. part: the place of the section that begins its part.
std::string content_of(const PageSection& section, std::size_t part, Drawn& drawn) {
  std::string html;
  if (!section.text.empty()) html += fmt::format("<p>{}</p>\n", escaped(section.text));
  if (const auto* table = std::get_if<PageTable>(&section.content)) return html + html_of(*table);
  if (const auto* list = std::get_if<std::vector<Chart>>(&section.content))
    return html + html_of(*list, part, drawn.charts);
  if (const auto* scene = std::get_if<PageScene>(&section.content))
    return html + html_of(*scene, part, drawn.scenes);
  if (const auto* details = std::get_if<std::vector<PageDetails>>(&section.content))
    return html + html_of(*details);
  if (const auto* paragraphs = std::get_if<PageParagraphs>(&section.content))
    return html + html_of(*paragraphs);
  return html + html_of(std::get<std::vector<PageImage>>(section.content), section);
}

/// first: the section that began it.
std::string end_of_part(const PageSection& first) {
  return first.folded ? "</details>\n</section>\n" : "</section>\n";
}

/// All sections; those of a part, which a section of level 2 begins, stand in an element of their own.
std::string body_of(const Page& page, Drawn& drawn) {
  std::string body;
  std::size_t part = 0;
  for (std::size_t place = 0; place < page.sections.size(); ++place) {
    const PageSection& section = page.sections[place];
    const bool begins_part = place == 0 || section.level == 2;
    if (begins_part) {
      if (place > 0) body += end_of_part(page.sections[part]);
      part = place;
      body += fmt::format("<section class=\"part{}\" id=\"part-{}\">\n", section.timeline ? " timeline" : "",
                          part);
    }
    body += heading_of(section, place) + content_of(section, part, drawn);
    if (section.folded && !begins_part) body += "</details>\n";
  }
  return page.sections.empty() ? body : body + end_of_part(page.sections[part]);
}

/// Links to the main sections, where there are many.
std::string contents_of(const Page& page) {
  constexpr std::size_t kMany = 4;
  std::string html;
  std::size_t count = 0;
  for (std::size_t place = 0; place < page.sections.size(); ++place) {
    if (page.sections[place].level != 2) continue;
    html += fmt::format("<a href=\"#section-{}\">{}</a>\n", place, escaped(page.sections[place].title));
    ++count;
  }
  const bool parts = std::ranges::any_of(page.sections, [](const PageSection& s) { return s.level > 2; });
  return count >= kMany || parts ? "<nav>\n" + html + "</nav>\n" : std::string();
}

}  // namespace

std::string to_html(const Page& page) {
  Drawn drawn;
  std::string body = contents_of(page) + body_of(page, drawn);
  body += fmt::format(
      "<script type=\"application/json\" id=\"charts\">{}</script>\n<script>{}</script>\n"
      "<script>\n{}{}{}{}{}</script>\n",
      script_safe(drawn.charts), chart_library(), chart_axes_script(), chart_plugins_script(), page_script(),
      timeline_script(), zoom_script());
  if (!drawn.scenes.empty()) {
    body += fmt::format(
        "<script type=\"application/json\" "
        "id=\"scenes\">{}</script>\n<script>{}</script>\n<script>{}</script>\n"
        "<script>\n{}{}</script>\n",
        script_safe(drawn.scenes), scene_library(), scene_controls(), scene_camera_script(), scene_script());
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>\n{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<p>{1}</p>\n"
      "<noscript><p>The charts need JavaScript; everything else is here.</p></noscript>\n{3}"
      "</body>\n</html>\n",
      escaped(page.title), escaped(page.subtitle), page_style(), body);
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

}  // namespace fusebench::page
