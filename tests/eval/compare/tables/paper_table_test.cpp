#include "eval/compare/tables/paper_table.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fusebench {

using namespace metrics;
using namespace record;
using namespace run_files;
using namespace tables;

namespace {

FoundRun run_of(const std::string& recording, const std::string& variant, double aie_grey,
                const std::string& imu = "recorded") {
  RunRecord record;
  record.status = RunStatus::ok;
  record.recording.name = recording;
  record.recording.frames = 613;
  record.recording.imu = imu;
  record.recording.truth = "given";
  record.variant = variant;
  IntensityResult aie;
  aie.all.aie_grey = aie_grey;
  record.metrics.aie = {aie, {}};
  return {"nowhere", record};
}

TEST(PaperTable, StandsBesideWhatWasRunHereAndIsNotMixed) {
  const auto published = published_table("table1");
  ASSERT_TRUE(published.has_value()) << published.error().message;
  EXPECT_TRUE(published->verified);
  const PaperTable table =
      paper_table(*published, {run_of("elsewhere", "dm", 5), run_of("elsewhere", "full", 4),
                               run_of("rgbd_dataset_freiburg1_desk", "dm", 12),
                               run_of("rgbd_dataset_freiburg1_desk", "full", 8)});
  ASSERT_EQ(table.rows.size(), 6U);  // five of the paper, and one that it does not have
  const PaperRow& desk = table.rows[0];
  EXPECT_EQ(desk.label, "TUM_freiburg1_desk");
  EXPECT_EQ(desk.data, "recorded, 613 frames");
  EXPECT_EQ(desk.published[0], 13.3756);
  EXPECT_EQ(desk.here[0], 12);
  EXPECT_NEAR(*desk.published_ratio, 13.3756 / 9.53, 1e-12);
  EXPECT_EQ(*desk.here_ratio, 1.5);
  EXPECT_FALSE(desk.common_ratio.has_value());  // there are no intensity files
  EXPECT_TRUE(table.rows[1].data.empty());
  EXPECT_FALSE(table.rows[1].here_ratio.has_value());
  EXPECT_EQ(table.rows[5].label, "elsewhere");
  EXPECT_EQ(table.rows[5].group, "not published");

  const std::string text = render_paper_table(table, TableFormat::markdown);
  EXPECT_NE(text.find("DM (published)"), std::string::npos) << text;
  EXPECT_NE(text.find("dm (here)"), std::string::npos);
  EXPECT_NE(render_paper_table(table, TableFormat::markdown, {}, 80).find("\n\n| group"), std::string::npos);
  EXPECT_NE(text.find("not run"), std::string::npos);
  const std::string lines = render_paper_table(table, TableFormat::csv);
  EXPECT_NE(lines.find("table1,aie_grey,slow,TUM_freiburg1_desk,published,true,DM,13.3756\n"),
            std::string::npos)
      << lines;
  EXPECT_NE(lines.find("table1,aie_grey,slow,TUM_freiburg1_desk,here,true,dm,12\n"), std::string::npos);
  const auto document = nlohmann::json::parse(render_paper_table(table, TableFormat::json));
  EXPECT_TRUE(document.at("rows").at(1).at("here").at("dm").is_null());
}

TEST(PaperTable, AnImuMadeFromTheTruthIsBesideNoPublishedNumber) {
  const PaperTable table = paper_table(*published_table("table1"),
                                       {run_of("rgbd_dataset_freiburg1_desk", "dm", 12, "synthetic IMU"),
                                        run_of("rgbd_dataset_freiburg1_desk", "full", 8, "synthetic IMU"),
                                        run_of("rgbd_dataset_freiburg1_desk", "no-imu", 9, "none")});
  EXPECT_EQ(table.systems_here, (std::vector<std::string>{"dm", "full", "no-imu"}));
  ASSERT_EQ(table.rows.size(), 6U);
  EXPECT_EQ(table.rows[0].data, "recorded, 613 frames");
  EXPECT_FALSE(table.rows[0].here[0] || table.rows[0].here[1]);
  EXPECT_EQ(table.rows[0].here[2], 9);
  const PaperRow& synthetic = table.rows[5];
  EXPECT_EQ(synthetic.group, "IMU made from the ground truth");
  EXPECT_EQ(synthetic.label, "rgbd_dataset_freiburg1_desk");
  EXPECT_FALSE(synthetic.published[0] || synthetic.published[1]);
  EXPECT_EQ(synthetic.here[0], 12);
  EXPECT_EQ(synthetic.here_ratio, 1.5);
}

TEST(PaperTable, ImportsHaveColumnsAndThePlainRunCounts) {
  FoundRun imported = run_of("rgbd_dataset_freiburg1_desk", "ORB-SLAM3", 1, "none");
  FoundRun edited = run_of("rgbd_dataset_freiburg1_desk", "no-imu", 1, "none");
  FoundRun plain = edited;
  for (auto [run, ate_m] : {std::pair(&imported, 0.016), std::pair(&edited, 0.5), std::pair(&plain, 0.02)}) {
    trajectory_error::AteResult ate;
    ate.stats.rmse = ate_m;
    run->record.metrics.ate = {ate, {}};
  }
  edited.record.config = {{"tsdf.voxel_m", 0.05, "--set"}};
  plain.record.config = {{"tsdf.voxel_m", 0.01, "default"}};
  const PaperTable table = paper_table(*published_table("ate_tum"), {edited, plain, imported});
  EXPECT_EQ(table.systems_here, (std::vector<std::string>{"full", "no-imu", "ORB-SLAM3"}));
  EXPECT_EQ(table.rows[0].label, "fr1/desk");
  EXPECT_EQ(table.rows[0].here[1], 0.02);
  EXPECT_EQ(table.rows[0].here[2], 0.016);
  const PaperTable alone = paper_table(*published_table("ate_tum"), {edited, imported});
  EXPECT_EQ(alone.rows[0].here[1], 0.5);
  EXPECT_NE(render_paper_table(alone, TableFormat::markdown).find("with tsdf.voxel_m=0.05"),
            std::string::npos);
}

TEST(PaperTable, WhatIsNotVerifiedIsMarked) {
  for (const char* const name : {"ate_tum", "ate_icl", "surface_icl"}) {
    const auto published = published_table(name);
    ASSERT_TRUE(published.has_value()) << published.error().message;
    const std::string text =
        render_paper_table(paper_table(*published, {run_of("x", "full", 1)}), TableFormat::markdown);
    EXPECT_NE(text.find("NOT verified"), std::string::npos) << text;
  }
  EXPECT_EQ(published_table("table9").error().code, ErrorCode::usage);
  EXPECT_NE(published_table("table9").error().hint.find("table1"), std::string::npos);
}

TEST(PublishedTable, NamesWhatIsWrong) {
  const auto refusal = [](const std::string& text) {
    const auto table = parse_published_table(text, "x.toml");
    return table ? std::string("was not refused") : table.error().message;
  };
  const std::string head =
      "name = \"t\"\ntitle = \"t\"\nsource = \"s\"\nvalue = \"aie_grey\"\nsystems = [\"a\", \"b\"]\n";
  EXPECT_NE(refusal("name = 3\n").find("x.toml:1: name must be a text"), std::string::npos);
  EXPECT_NE(refusal("colour = \"red\"\n").find("unknown key colour"), std::string::npos);
  EXPECT_NE(refusal("value = \"speed\"\n").find("a value of runs"), std::string::npos);
  EXPECT_NE(refusal("name = \"t\"\n").find("needs name, title"), std::string::npos);
  EXPECT_NE(refusal(head + "[[rows]]\nlabel = \"l\"\npublished = [1.0]\n")
                .find("1 published numbers for 2 systems"),
            std::string::npos);
  EXPECT_NE(refusal(head + "[[rows]]\nlabel = \"l\"\npublished = [1.0, \"x\"]\n").find("a list of numbers"),
            std::string::npos);
}

}  // namespace
}  // namespace fusebench
