// Results as evo v1.36.5 makes them: titles, labels and errors of its own evaluations.
#include "eval/report/evo_results/evo_result.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/report/evo_results/result_archive.hpp"
#include "eval/report/evo_results/result_table.hpp"
#include "eval/report/evo_results/zip_archive.hpp"
#include "tests/support/trajectory_vectors.hpp"

namespace fusebench {

using namespace evo_results;
using namespace trajectory_error;

namespace {

using nlohmann::json;
using testing::expect_close;

/// The options of a command of evo, as ours.
TrajectoryRequest request_of(const json& test) {
  const json& given = test.at("options");
  const auto metric = test.at("metric") == "ape" ? TrajectoryMetric::ate : TrajectoryMetric::rpe;
  TrajectoryRequest request = request_for(Protocol::evo, metric).value();
  request.keep_poses = true;
  if (given.contains("r")) request.relation = parse_pose_relation(given.at("r").get<std::string>()).value();
  const bool scale = given.value("scale", 0) == 1;
  if (scale) request.alignment.mode = AlignmentMode::scale;
  if (given.value("align", 0) == 1) request.alignment.mode = scale ? AlignmentMode::sim3 : AlignmentMode::se3;
  if (given.value("origin", 0) == 1) {
    request.alignment.mode = AlignmentMode::origin;
    request.alignment.scale_origin = scale;
  }
  request.alignment.first = given.value("n_to_align", std::size_t{0});
  auto& association = request.association;
  association.max_difference_s = given.value("t_max_diff", association.max_difference_s);
  association.offset_s = given.value("t_offset", 0.0);
  association.start_s = given.value("t_start", association.start_s);
  association.end_s = given.value("t_end", association.end_s);
  const std::string plane = given.value("plane", "");
  request.plane = plane == "xy"   ? Plane::xy
                  : plane == "xz" ? Plane::xz
                  : plane == "yz" ? Plane::yz
                                  : Plane::none;
  request.delta.value = given.value("delta", 1.0);
  if (given.contains("delta_unit"))
    request.delta.unit = parse_delta_unit(given.at("delta_unit").get<std::string>()).value();
  if (given.value("all_pairs", 0) == 1) request.motions = MotionRule::all;
  request.delta_tolerance = given.value("delta_tol", 0.1);
  request.from_reference = given.value("pairs_from_reference", 0) == 1;
  request.downsample = given.value("downsample", std::size_t{0});
  if (given.contains("motion_filter"))
    request.motion_filter = MotionFilter{given.at("motion_filter")[0], radians(given.at("motion_filter")[1])};
  return request;
}

class EvoResults : public testing::TrajectoryVectors {
 protected:
  [[nodiscard]] Trajectory load(const json& test, const char* side) const {
    std::vector<std::string> warnings;
    return trajectory::read_tum_trajectory(input(test.at(side).get<std::string>()), warnings,
                                           trajectory::Duplicates::as_written)
        .value();
  }
  [[nodiscard]] Result<EvoResult> evaluated(const json& test) const {
    auto evaluation = evaluate(load(test, "gt"), load(test, "est"), request_of(test));
    if (!evaluation) return tl::unexpected(evaluation.error());
    if (test.at("options").contains("change_unit")) {
      const auto changed = change_unit(evaluation->series.front(), test.at("options").at("change_unit"));
      EXPECT_TRUE(changed.has_value());
    }
    return result_of(*evaluation, {test.at("gt"), test.at("est"), true});
  }
};
OVER_BOTH_VECTOR_SETS(EvoResults);

/// evo's lines, as the vectors separate them.
std::string title_of(const json& test) {
  std::string title = test.at("title");
  for (std::size_t at = 0; (at = title.find(" | ", at)) != std::string::npos;) title.replace(at, 3, "\n");
  return title;
}

TEST_P(EvoResults, TitlesLabelsErrorsAndAlignments) {
  int compared = 0;
  for (const json& test : cases("evo_expected.json")) {
    SCOPED_TRACE(test.at("id").get<std::string>() + ": " + test.at("command").get<std::string>());
    const auto result = evaluated(test);
    if (!result) continue;  // what is refused, and why, is tested where it is computed
    EXPECT_EQ(result->title, title_of(test));
    EXPECT_EQ(result->label, test.at("label").get<std::string>());
    const std::vector<double>& errors = result->array("error_array")->values;
    ASSERT_EQ(errors.size(), test.at("n_errors").get<std::size_t>());
    const bool angle = test.at("options").value("r", "").starts_with("angle");
    const double absolute =
        angle ? 1e-6 : 1e-7;  // evo's go through matrices, whose rounding is some 1e-8 there
    const std::size_t shown = std::min<std::size_t>(5, errors.size());
    for (std::size_t i = 0; i < shown; ++i) {
      EXPECT_NEAR(errors[i], test.at("error_first5")[i].get<double>(), absolute);
      EXPECT_NEAR(errors[errors.size() - shown + i], test.at("error_last5")[i].get<double>(), absolute);
    }
    for (const auto& [name, value] : result->stats) {
      EXPECT_TRUE(test.at("stats").contains(name)) << name;
    }
    EXPECT_EQ(result->stats.size(), test.at("stats").size());
    EXPECT_EQ(result->array("alignment_transformation_sim3") != nullptr,
              test.contains("alignment_sim3_row_major"));
    for (const char* name : {"seconds_from_start", "timestamps", "distances_from_start", "distances"}) {
      ASSERT_NE(result->array(name), nullptr) << name;
      EXPECT_EQ(result->array(name)->values.size(), errors.size()) << name;
    }
    ++compared;
  }
  EXPECT_EQ(compared, count(38, 123));
}

/// Three poses each; the estimate 1 cm aside, and 2 cm at the end.
TrajectoryEvaluation small(TrajectoryMetric metric) {
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i < 3; ++i) {
    reference.push_back({1'305'031'100'000'000'000 + i * 500'000'000LL, {{}, Vector3d(3.0 * i, 4.0 * i, 0)}});
    estimate.push_back(reference.back());
    estimate.back().T_world_camera.translation.z() += i == 2 ? 0.02 : 0.01;
  }
  TrajectoryRequest request = request_for(Protocol::evo, metric).value();
  request.keep_poses = true;
  return evaluate(reference, estimate, request).value();
}

TEST(EvoResult, ArraysOfPoses) {
  const EvoResult result = result_of(small(TrajectoryMetric::ate), {"../gt.txt", "runs/est.txt", true});
  EXPECT_EQ(result.array("seconds_from_start")->values, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(result.array("timestamps")->values, (std::vector<double>{1305031100, 1305031100.5, 1305031101}));
  EXPECT_EQ(result.array("distances_from_start")->values, (std::vector<double>{0, 5, 10}));
  EXPECT_GT(result.array("distances")->values.back(), 10) << "along the estimate";
  EXPECT_EQ(result.trajectories[1].poses.size(), 3U);
  EXPECT_EQ(result.array("alignment_transformation_sim3"), nullptr);
}

TEST(EvoResult, ArraysOfMotionsBelongToTheirEnds) {
  const EvoResult result = result_of(small(TrajectoryMetric::rpe), {"gt.txt", "est.txt", true});
  ASSERT_EQ(result.array("error_array")->values.size(), 2U);
  EXPECT_EQ(result.array("seconds_from_start")->values, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(result.array("distances_from_start")->values, (std::vector<double>{5, 10}));
  EXPECT_EQ(result.trajectories[0].poses.size(), 3U) << "with the first pose, which no motion ends at";
}

TEST(EvoResult, WithoutStampsThereAreErrorsAlone) {
  const EvoResult result = result_of(small(TrajectoryMetric::ate), {"gt.txt", "est.txt", false});
  EXPECT_EQ(result.arrays.size(), 1U);
  const auto entries = archive_of(result);
  EXPECT_NE(entries->find("gt.txt.kitti"), std::string::npos);
}

class ResultArchive : public testing::InTemporaryFolder {
 protected:
  std::filesystem::path saved(const char* name, const EvoResult& result) {
    return write(name, archive_of(result).value());
  }
};

TEST_F(ResultArchive, WhatIsWrittenIsReadBack) {
  const EvoResult result = result_of(small(TrajectoryMetric::ate), {"../gt.txt", "runs/est.txt", true});
  const auto again = read_result(saved("a.zip", result));
  ASSERT_TRUE(again.has_value()) << again.error().message;
  EXPECT_EQ(again->title, result.title);
  EXPECT_EQ(again->label, result.label);
  EXPECT_EQ(again->reference_name, "../gt.txt");
  EXPECT_EQ(again->estimate_name, "runs/est.txt");
  EXPECT_EQ(again->stats, result.stats) << "no digit is lost";
  ASSERT_EQ(again->arrays.size(), result.arrays.size());
  for (const auto& [name, array] : result.arrays) EXPECT_EQ(again->array(name)->values, array.values) << name;
}

TEST_F(ResultArchive, NamesOfFilesStayWithinTheArchive) {
  const EvoResult result =
      result_of(small(TrajectoryMetric::ate), {"/data/../x/t.txt", "../x/./t.txt", true});
  const auto entries = read_zip(saved("a.zip", result));
  EXPECT_EQ((*entries)[entries->size() - 2].name, "data/x/t.txt.tum");
  EXPECT_EQ(entries->back().name, "x/t.txt.tum");
  const EvoResult itself = result_of(small(TrajectoryMetric::ate), {"t.txt", "t.txt", true});
  EXPECT_EQ(read_zip(saved("b.zip", itself))->back().name, "estimate/t.txt.tum") << "no two of one name";
}

TEST_F(ResultArchive, WhatIsNoResultIsRefused) {
  const auto refused = [&](const std::vector<ZipEntry>& entries, std::string_view part) {
    const auto result = read_result(write("a.zip", zip_bytes(entries).value()));
    ASSERT_FALSE(result.has_value()) << part;
    EXPECT_EQ(result.error().code, ErrorCode::data_corrupt);
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
  };
  const std::string errors = npy_bytes(row_of({1}));
  refused({{"a.txt", ""}}, "no info.json");
  refused({{"info.json", "{}"}, {"stats.json", "[]"}, {"error_array.npy", errors}},
          "no info.json and stats.json");
  refused({{"info.json", "{}"}, {"stats.json", "{\"rmse\": \"1\"}"}, {"error_array.npy", errors}},
          "rmse is no number");
  refused({{"info.json", "{}"}, {"stats.json", "{\"rmse\": 1}"}}, "no errors");
  refused({{"info.json", "{}"}, {"stats.json", "{\"rmse\": 1}"}, {"error_array.npy", "?"}},
          "no array of NumPy");
  const std::string endless = npy_bytes(row_of({std::numeric_limits<double>::infinity()}));
  refused({{"info.json", "{}"}, {"stats.json", "{\"rmse\": 1}"}, {"error_array.npy", endless}}, "not finite");
}

TEST_F(ResultArchive, TablesAndWhatTheyAreNotMadeOf) {
  EvoResult result = result_of(small(TrajectoryMetric::ate), {"gt.txt", "runs/a.txt", true});
  const auto first = saved("a.zip", result);
  const auto copy = saved("copy.zip", result);
  result.estimate_name = "b, c.txt";
  result.stats.front().second = 0.5;
  const auto second = saved("b.zip", result);
  const auto both = load_results({first, second}, {});
  ASSERT_TRUE(both.has_value()) << both.error().message;
  const std::string csv = to_csv(*both);
  EXPECT_TRUE(csv.starts_with(",max,mean,median,min,rmse,sse,std\na.txt,0.02")) << csv;
  EXPECT_NE(csv.find("\n\"b, c.txt\","), std::string::npos) << csv;
  EXPECT_NE(csv.find(",0.5,"), std::string::npos) << csv;

  const auto twice = load_results({first, copy}, {});
  ASSERT_FALSE(twice.has_value());
  EXPECT_NE(twice.error().hint.find("--use_filenames"), std::string::npos);
  EXPECT_EQ(load_results({first, copy}, {.use_filenames = true})->at(1).label, copy.string());

  const auto motions = saved("m.zip", result_of(small(TrajectoryMetric::rpe), {"gt.txt", "m.txt", true}));
  const auto mixed = load_results({first, motions}, {});
  ASSERT_FALSE(mixed.has_value());
  EXPECT_NE(mixed.error().message.find("'RPE w.r.t. translation part (m) for delta = 1"), std::string::npos)
      << mixed.error().message;
  EXPECT_EQ(load_results({first, motions}, {.ignore_title = true})->size(), 2U);
}

TEST_F(ResultArchive, MergedResultsAreAveraged) {
  EvoResult result = result_of(small(TrajectoryMetric::ate), {"gt.txt", "a.txt", true});
  const auto first = saved("a.zip", result);
  for (double& error : result.arrays.front().second.values) error += 2;
  for (auto& [name, value] : result.stats) value += 4;
  const auto merged = load_results({first, saved("b.zip", result)}, {.merge = true});
  ASSERT_TRUE(merged.has_value()) << merged.error().message;
  ASSERT_EQ(merged->size(), 1U);
  const EvoResult before = read_result(first).value();
  const EvoResult& all = merged->front().result;
  for (std::size_t i = 0; i < all.stats.size(); ++i)
    EXPECT_NEAR(all.stats[i].second, before.stats[i].second + 2, 1e-12) << all.stats[i].first;
  EXPECT_NEAR(all.arrays.front().second.values[0], before.arrays.front().second.values[0] + 1, 1e-12);
  result.arrays.front().second = row_of({1, 2, 3, 4});
  EXPECT_EQ(load_results({first, saved("b.zip", result)}, {.merge = true})
                ->front()
                .result.array("error_array")
                ->values.size(),
            7U)
      << "of other numbers of errors, all";
}

}  // namespace
}  // namespace fusebench
