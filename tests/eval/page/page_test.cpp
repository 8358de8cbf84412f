#include "eval/page/page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "eval/page/figures.hpp"
#include "eval/page/series_colours.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace page;

namespace {

std::string html_of(PageSection section) { return to_html({"t", "", {std::move(section)}}); }

TEST(Page, ColumnsOfNumbersAreMarkedAndTheBestOfThemIs) {
  PageTable table;
  table.header = {"run", "ATE", "tracked", "left"};
  table.rows = {{{"full", "1.20", "12/34", "5 of 7"}, "", {1}}, {{"dm", "-", "", "none"}, ""}};
  const std::string html = html_of({"s", "", table});
  testing::expect_contains(html, "<table class=\"n2 n3\">");
  testing::expect_contains(html, "<td>full</td><td class=\"best\">1.20</td>");
  testing::expect_contains(html, "<th scope=\"col\">ATE</th>");
}

TEST(Page, ASortableTableKeepsItsMeansAtTheEnd) {
  PageTable table;
  table.header = {"run", "ATE"};
  table.rows = {{{"full", "1.20"}, "warning"}, {{"mean", "1.20"}, "", {}, true}};
  table.sortable = true;
  const std::string html = html_of({"s", "", table});
  testing::expect_contains(html, "<table class=\"n2 sortable\">");
  testing::expect_contains(html, "<tr class=\"warning\"><td>full</td>");
  testing::expect_contains(html, "<tr class=\"fixed\"><td>mean</td>");
}

TEST(Page, AFoldedPartHoldsItsSectionsAndAFoldedSectionItself) {
  PageSection part{"part", "", PageParagraphs{{"in the part"}}};
  part.folded = true;
  PageSection notes{"notes", "", PageParagraphs{{"in the notes"}}, 3};
  notes.folded = true;
  PageSection after{"after", "", PageParagraphs{{"behind"}}};
  const std::string html = to_html({"t", "", {part, notes, after}});
  const std::string body = html.substr(html.find("<section"), html.find("<script") - html.find("<section"));
  EXPECT_EQ(body,
            "<section class=\"part\" id=\"part-0\">\n"
            "<details class=\"fold\"><summary><h2 id=\"section-0\">part</h2>\n</summary>\n"
            "<div class=\"paragraphs\">\n<p>in the part</p>\n</div>\n"
            "<details class=\"fold\"><summary><h3 id=\"section-1\">notes</h3>\n</summary>\n"
            "<div class=\"paragraphs\">\n<p>in the notes</p>\n</div>\n</details>\n"
            "</details>\n</section>\n"
            "<section class=\"part\" id=\"part-2\">\n<h2 id=\"section-2\">after</h2>\n"
            "<div class=\"paragraphs\">\n<p>behind</p>\n</div>\n</section>\n");
}

TEST(Page, ANumberOutsideOfItsRangeIsANumberStill) {
  PageTable table;
  table.header = {"variant", "NEES / dof", "text"};
  table.rows = {{{"full", "1.31 ! (0.85 .. 1.16)", "! 1"}, ""}, {{"dm", "1.02 (0.85 .. 1.16)", "2"}, ""}};
  testing::expect_contains(html_of({"s", "", table}), "<table class=\"n2\">");
}

TEST(Page, PartsHaveAnElementAndTheirChartsKnowIt) {
  Chart chart;
  chart.x_label = "time [s]";
  chart.series = {{"full", {{0, 1}, {1, 2}}}};
  chart.y_range = Vector2d(0, 5);
  chart.x_names = {"<a>"};
  PageSection first{"one", "", PageParagraphs{{"a < b"}}};
  PageSection second{"two", "", std::vector<Chart>{chart}};
  second.timeline = true;
  PageSection third{"three", "", std::vector<PageImage>{{"c", "data:image/jpeg;base64,x", 1.5}}, 3};
  third.strip = true;
  const std::string html = to_html({"t", "", {first, second, third}});
  testing::expect_contains(html, "<p>a &lt; b</p>");
  testing::expect_contains(html, "<section class=\"part timeline\" id=\"part-1\">");
  EXPECT_EQ(html.find("id=\"part-2\""), std::string::npos) << "a section of level 3 begins no part";
  testing::expect_contains(html, "\"yRange\":[0.0,5.0],\"part\":1");
  testing::expect_contains(html, "\\u003ca>");
  testing::expect_contains(html, "<div class=\"strip\"");
  testing::expect_contains(html, "<figure data-time=\"1.5\">");
}

TEST(Page, FiguresAreCutAsChartsAreAndNameTheirPlaces) {
  Chart chart;
  chart.series = {{"full", {{1, 1}}, SeriesStyle::line}, {"full, 3 sigma", {{1, 2}}, SeriesStyle::band}};
  chart.y_range = Vector2d(0, 5);
  chart.x_names = {"fr1_xyz", "fr1_rpy"};
  const std::string script = gnuplot_script(chart, "f.svg", FigureFormat::svg);
  testing::expect_contains(script, "set yrange [0:5]");
  testing::expect_contains(script, "\"fr1_xyz\" 1, \"fr1_rpy\" 2");
  EXPECT_LT(script.find("filledcurves y1=0"), script.find("with lines")) << "a band would hide the line";
}

TEST(Page, FiguresOfLongNamesHaveFilesOfTheirOwn) {
  Chart chart;
  chart.series = {{"full", {{0, 1}, {1, 2}}, SeriesStyle::line}};
  std::vector<Chart> charts(2, chart);
  charts[0].title = fmt::format("{:x>250}", "a");
  charts[1].title = fmt::format("{:x>250}", "b");
  const testing::TemporaryFolder folder;
  const auto drawn = write_figures({"t", "", {{"desk", "", charts}}}, folder.path(), FigureFormat::svg);
  if (!drawn && drawn.error().code == ErrorCode::usage) GTEST_SKIP() << drawn.error().message;
  ASSERT_TRUE(drawn.has_value()) << drawn.error().message;
  EXPECT_EQ(*drawn, 2U);
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_LE(entry.path().filename().string().size(), 220U);
    if (entry.path().extension() == ".svg") ++figures;
  }
  EXPECT_EQ(figures, 2U);
}

TEST(SeriesColours, AVariantHasItsOwnOnEveryPage) {
  const auto some = series_colours(std::vector<ColouredName>{{"full ", 0}, {"no-imu ", 2}});
  const auto all =
      series_colours(std::vector<ColouredName>{{"no-imu ", 2}, {"dm ", 1}, {"full ", 0}, {"no-imu ", 2}});
  EXPECT_EQ(some, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(all, (std::vector<std::size_t>{3, 2, 1, 3}));
}

TEST(SeriesColours, OtherOptionsAndOtherSystemsGetFreeOnes) {
  // The variant of rank 10 would have the colour of the first.
  const auto colours = series_colours(
      std::vector<ColouredName>{{"full ", 0}, {"full tsdf.voxel_m=0.01", 0}, {"literal ", 10}});
  EXPECT_EQ(colours, (std::vector<std::size_t>{1, 2, 3}));
  std::vector<ColouredName> many;
  for (std::size_t i = 0; i < 30; ++i) many.push_back({std::to_string(i), 0});
  for (const std::size_t colour : series_colours(many)) {
    EXPECT_GT(colour, 0U) << "that of the ground truth";
    EXPECT_LT(colour, kSeriesColours);
  }
}

}  // namespace
}  // namespace fusebench
