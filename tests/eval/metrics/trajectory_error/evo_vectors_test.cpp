// Against numbers that evo v1.36.5 computed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/metrics/trajectory_error/trajectory_error.hpp"
#include "eval/metrics/trajectory_files/nearest_association.hpp"
#include "tests/support/trajectory_vectors.hpp"

namespace fusebench {

using namespace trajectory;
using namespace trajectory_files;
using namespace trajectory_error;

namespace {

using nlohmann::json;
using testing::expect_close;
using testing::kAbsolute;

class EvoVectors : public testing::TrajectoryVectors {
 protected:
  [[nodiscard]] Trajectory load(const json& test, const char* side) const {
    std::vector<std::string> warnings;
    auto trajectory =
        read_tum_trajectory(input(test.at(side).get<std::string>()), warnings, Duplicates::as_written);
    EXPECT_TRUE(trajectory.has_value()) << trajectory.error().message;
    return *trajectory;
  }

  [[nodiscard]] Result<TrajectoryError> evaluate(const json& test) const;
};
OVER_BOTH_VECTOR_SETS(EvoVectors);

/// The options of a command of evo, as ours.
struct EvoOptions {
  explicit EvoOptions(const json& given) {
    if (given.contains("r")) relation = parse_pose_relation(given.at("r").get<std::string>()).value();
    const bool scale = given.value("scale", 0) == 1;
    if (given.value("align", 0) == 1) {
      alignment.mode = scale ? AlignmentMode::sim3 : AlignmentMode::se3;
    } else if (given.value("origin", 0) == 1) {
      alignment.mode = AlignmentMode::origin;
      alignment.scale_origin = scale;
    } else if (scale) {
      alignment.mode = AlignmentMode::scale;
    }
    alignment.first = given.value("n_to_align", std::size_t{0});
    association.max_difference_s = given.value("t_max_diff", 0.01);
    association.offset_s = given.value("t_offset", 0.0);
    association.start_s = given.value("t_start", association.start_s);
    association.end_s = given.value("t_end", association.end_s);
    const std::string flat = given.value("plane", "");
    plane = flat == "xy" ? Plane::xy : flat == "xz" ? Plane::xz : flat == "yz" ? Plane::yz : Plane::none;
    delta.value = given.value("delta", 1.0);
    if (given.contains("delta_unit"))
      delta.unit = parse_delta_unit(given.at("delta_unit").get<std::string>()).value();
    factor = given.value("change_unit", "") == "cm" ? 100 : 1;
  }

  AssociationOptions association;
  AlignmentRequest alignment;
  PoseRelation relation = PoseRelation::translation;
  Plane plane = Plane::none;
  Delta delta;
  double factor = 1;
};

Trajectory thinned(Trajectory trajectory, const json& given) {
  if (given.contains("downsample"))
    trajectory = downsampled(trajectory, given.at("downsample").get<std::size_t>());
  if (given.contains("motion_filter"))
    trajectory = moved_only(trajectory, given.at("motion_filter")[0], radians(given.at("motion_filter")[1]));
  return trajectory;
}

Result<TrajectoryError> EvoVectors::evaluate(const json& test) const {
  const json& given = test.at("options");
  const EvoOptions options(given);
  const auto pair =
      pair_up(thinned(load(test, "gt"), given), thinned(load(test, "est"), given), options.association);
  if (!pair) return tl::unexpected(pair.error());
  EXPECT_EQ(pair->size(), test.at("n_pairs").get<std::size_t>());
  if (test.at("metric") == "ape")
    return absolute_error(*pair, AbsoluteOptions{options.relation, options.alignment, options.plane});
  RelativeOptions relative{options.relation, options.alignment, options.plane, options.delta};
  if (given.value("all_pairs", 0) == 1) relative.selection = MotionSelection::all;
  relative.tolerance = given.value("delta_tol", 0.1);
  relative.from_reference = given.value("pairs_from_reference", 0) == 1;
  return relative_error(*pair, relative);
}

TEST_P(EvoVectors, AbsoluteAndRelativeErrors) {
  int compared = 0;
  for (const json& test : cases("evo_expected.json")) {
    SCOPED_TRACE(test.at("id").get<std::string>() + ": " + test.at("command").get<std::string>());
    const std::string gt = test.at("gt");
    const bool aligned =
        test.at("options").value("align", 0) == 1 || test.at("options").value("scale", 0) == 1;
    const auto error = evaluate(test);
    // evo tests the rank absolutely, and lets a line through that lies obliquely.
    if (test.contains("raises") || (aligned && gt.find("collinear") != std::string::npos)) {
      EXPECT_FALSE(error.has_value());
      ++compared;
      continue;
    }
    if (!error) {
      ADD_FAILURE() << error.error().message;
      continue;
    }
    EXPECT_EQ(error->errors.size(), test.at("n_errors").get<std::size_t>());
    const double factor = EvoOptions(test.at("options")).factor;
    const json& stats = test.at("stats");
    // Angles near zero: evo's go through matrices, whose rounding is some 1e-8 rad there.
    const bool angle = error->relation != PoseRelation::translation;
    const double absolute = angle ? 1e-7 : kAbsolute;
    for (const auto& [name, value] : {std::pair{"rmse", error->stats.rmse},
                                      {"mean", error->stats.mean},
                                      {"median", error->stats.median},
                                      {"std", error->stats.std},
                                      {"max", error->stats.max}})
      expect_close(factor * value, stats.at(name), name);
    expect_close(factor * error->stats.min, stats.at("min"), "min", absolute);
    expect_close(factor * factor * error->stats.sse, stats.at("sse"), "sse");
    // Of `-s` alone evo says the whole alignment, but applies the scale; with an origin it leaves the scale
    // out.
    if (test.contains("alignment_sim3_row_major") && error->alignment_mode != AlignmentMode::scale) {
      const bool by_origin = error->alignment_mode == AlignmentMode::origin;
      const Matrix3d R =
          (by_origin ? 1.0 : error->alignment.scale) * error->alignment.rigid.rotation_matrix();
      for (int k = 0; k < 9; ++k)
        EXPECT_NEAR(
            R(k / 3, k % 3),
            test.at("alignment_sim3_row_major")[static_cast<std::size_t>(k / 3 * 4 + k % 3)].get<double>(),
            1e-9);
    }
    ++compared;
  }
  EXPECT_EQ(compared, count(48, 133));
}

TEST_P(EvoVectors, PairsOfMotions) {
  int compared = 0;
  for (const json& test : cases("evo_rpe_pairs.json")) {
    Delta delta{test.at("delta"), parse_delta_unit(test.at("delta_unit").get<std::string>()).value()};
    SCOPED_TRACE(test.at("gt").get<std::string>() + " " + test.at("pairs_from").get<std::string>() + " " +
                 std::to_string(delta.value) + test.at("delta_unit").get<std::string>());
    const auto pair = pair_up(load(test, "gt"), load(test, "est"), {});
    ASSERT_TRUE(pair.has_value());
    const Trajectory& poses = test.at("pairs_from") == "est" ? pair->estimate : pair->reference;
    const bool sensible = check_delta(delta).has_value();
    IndexPairs motions;
    if (sensible) {
      motions = test.at("all_pairs").get<bool>() ? all_motions(poses, delta, test.value("delta_tol", 0.1))
                                                 : consecutive_motions(poses, delta);
    }
    ++compared;
    if (test.contains("raises")) {
      EXPECT_TRUE(motions.empty());
      continue;
    }
    ASSERT_EQ(motions.size(), test.at("n").get<std::size_t>());
    std::size_t sum_i = 0;
    std::size_t sum_j = 0;
    for (const auto& [i, j] : motions) {
      sum_i += i;
      sum_j += j;
    }
    EXPECT_EQ(sum_i, test.at("sum_i").get<std::size_t>());
    EXPECT_EQ(sum_j, test.at("sum_j").get<std::size_t>());
  }
  EXPECT_EQ(compared, count(32, 96));
}

TEST_P(EvoVectors, Association) {
  const auto stamps = [](const json& list) {
    std::vector<std::int64_t> result;
    for (const json& stamp : list) result.push_back(std::llround(stamp.get<double>() * 1e9));
    return result;
  };
  for (const json& test : cases("association_cases.json")) {
    const auto pairs = associate_nearest(stamps(test.at("ref")), stamps(test.at("est")), test.at("max_diff"),
                                         test.at("offset"));
    const json& expected = test.at("evo_ref_est_index_pairs");
    ASSERT_EQ(pairs.size(), expected.size()) << test.at("id");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_EQ(pairs[i].first, expected[i][0].get<std::size_t>()) << test.at("id");
      EXPECT_EQ(pairs[i].second, expected[i][1].get<std::size_t>()) << test.at("id");
    }
  }
}

}  // namespace
}  // namespace fusebench
