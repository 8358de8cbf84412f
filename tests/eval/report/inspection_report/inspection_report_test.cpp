// The three forms of an inspection: JSON, text, page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "eval/page/page.hpp"
#include "eval/report/inspection_report/depth_camera_report.hpp"
#include "eval/report/inspection_report/inspection_json.hpp"
#include "eval/report/inspection_report/inspection_page.hpp"
#include "eval/report/inspection_report/inspection_text.hpp"
#include "tests/datasets/inspection/clean_recording.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

using namespace recording;
using namespace inspection;
using namespace page;
using namespace inspection_report;

namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Inspection small_inspection() { return inspected(clean_recording({.frames = 30, .depth_factor = 5})); }

TEST(InspectionJson, HasTheKeysThatReadersRelyOn) {
  const auto json = nlohmann::json::parse(to_json(small_inspection()));
  EXPECT_EQ(json.at("recording"), "clean");
  EXPECT_EQ(json.at("format"), "memory");
  EXPECT_EQ(json.at("frames"), 30);
  EXPECT_EQ(json.at("imu"), "recorded");
  ASSERT_FALSE(json.at("findings").empty());
  EXPECT_EQ(json.at("findings")[0].at("severity"), "error");
  for (const char* key : {"code", "severity", "message", "hint"})
    EXPECT_TRUE(json.at("findings")[0].at(key).is_string());
  EXPECT_NEAR(json.at("stamps").at("color").at("rate_hz").get<double>(), 30, 0.01);
  EXPECT_EQ(json.at("imu_alignment").at("rotation_imu_camera").size(), 3U);
  EXPECT_FALSE(json.at("reprojection").at("pairs").empty());
}

TEST(InspectionJson, ARefusedRecordingHasOneFinding) {
  const Error error{ErrorCode::data_corrupt, "rgb.txt:3: \"quoted\"", "hint"};
  const auto json = nlohmann::json::parse(to_json(refused_inspection("name", "tum", error)));
  ASSERT_EQ(json.at("findings").size(), 1U);
  EXPECT_EQ(json.at("findings")[0].at("code"), "cannot-open");
  EXPECT_EQ(json.at("findings")[0].at("message"), "rgb.txt:3: \"quoted\"");
}

TEST(InspectionText, PutsErrorsFirst) {
  const std::string text = to_text(small_inspection());
  EXPECT_THAT(text, HasSubstr("clean (memory): 30 frames"));
  EXPECT_LT(text.find("error    depth"), text.find("note "));
  EXPECT_THAT(text, HasSubstr("angular speed"));
  EXPECT_THAT(text, HasSubstr("hypothesis: inverted poses"));
  EXPECT_THAT(text, ::testing::ContainsRegex("scaled depth +accepted \\("));
  EXPECT_THAT(text, ::testing::ContainsRegex("inverted poses +rejected \\("));
}

TEST(DepthCameraReport, AFitWithinItsUncertaintyIsRefused) {
  const recording::Recording recording = clean_recording({.frames = 2});
  inspection::measures::RegistrationFit fit;
  fit.gain_sigmas = 20;
  fit.moved_px = 25;
  fit.sigma_px = 3;
  EXPECT_TRUE(check_determined(fit, recording).has_value());
  EXPECT_THAT(depth_camera_text(fit, recording), HasSubstr("the depth camera is determined"));
  fit.moved_px = 13.2;
  fit.sigma_px = 17.3;
  const auto refused = check_determined(fit, recording);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::run_failed);
  EXPECT_THAT(refused.error().message, HasSubstr("edges move 13.2 +- 17.3 px"));
  EXPECT_FALSE(nlohmann::json::parse(depth_camera_json(fit, recording)).at("determined").get<bool>());
  fit.sigma_px = 3;
  fit.gain_sigmas = 2.7;
  EXPECT_THAT(check_determined(fit, recording).error().message,
              HasSubstr("gain only 2.7 standard deviations"));
  EXPECT_THAT(depth_camera_text(fit, recording), HasSubstr("not determined"));
}

TEST(InspectionPage, WritesEveryFiniteNumber) {
  Chart chart;
  chart.series.push_back({"tiny", {{5e-310, 0.123456789}}});
  EXPECT_THAT(to_html({"title", "", {{"section", "", std::vector<Chart>{chart}}}}),
              HasSubstr("e-310,0.123457]"));
}

TEST(InspectionPage, NeedsNoNetworkAndEscapes) {
  Recording recording = clean_recording({.frames = 30});
  recording.name = "<script>&";
  const std::string page = to_page(inspected(recording), recording);
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;&amp;"));
  EXPECT_THAT(page, HasSubstr("Chart.js v"));
  EXPECT_THAT(page, HasSubstr("data:image/jpeg;base64,/9j/"));
  for (const char* outside : {"src=\"http", "<link", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_THAT(page, HasSubstr("Linear speed"));
  EXPECT_EQ(page, to_page(inspected(recording, 1), recording));
}

TEST(Page, ThinningKeepsPeaks) {
  std::vector<Vector2d> points;
  for (int i = 0; i < 10'000; ++i) points.emplace_back(i, i == 4321 ? 9.0 : i == 777 ? -9.0 : 0.0);
  const auto fewer = thinned(points, 50);
  EXPECT_LE(fewer.size(), 100U);
  EXPECT_TRUE(std::ranges::count(fewer, Vector2d(4321, 9)) == 1 &&
              std::ranges::count(fewer, Vector2d(777, -9)) == 1);
  EXPECT_TRUE(std::ranges::is_sorted(fewer, {}, [](const Vector2d& p) { return p.x(); }));
}

TEST(FindingCodes, AreAllInTheDocumentation) {
  const std::string text = read_bytes(testing::repository_root() / "docs" / "inspect.md");
  for (const FindingCode& code : finding_codes()) EXPECT_THAT(text, HasSubstr(std::string(code.code)));
}

}  // namespace
}  // namespace fusebench::testing
