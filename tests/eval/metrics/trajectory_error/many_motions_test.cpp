// Relative errors over more motions than are listed: the same numbers to the bit, in little memory.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"
#include "tests/datasets/images/child_process.hpp"

namespace fusebench {

using namespace metrics;
using namespace trajectory_error;

namespace {

/// A camera on a wavy path that looks around, and the same with an error in each motion.
struct Pair {
  Trajectory truth;
  Trajectory estimate;
};
Pair wandering(std::size_t poses) {
  Pair pair;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1);
  SE3 seen;
  for (std::size_t i = 0; i < poses; ++i) {
    const double t = 0.05 * static_cast<double>(i);
    const SE3 truth{so3_exp(Vector3d(std::sin(t), 0.8 * std::sin(0.7 * t), std::cos(0.3 * t))),
                    Vector3d(std::sin(0.4 * t), t, std::cos(0.2 * t))};
    const auto error = [&](double size) {
      const double x = noise(random);
      const double y = noise(random);
      return Vector3d(size * x, size * y, size * noise(random));
    };
    seen = SE3{so3_exp(error(0.002)), error(0.003)} * seen;
    const auto stamp_ns = static_cast<std::int64_t>(i) * 50'000'000;
    pair.truth.push_back({stamp_ns, truth});
    pair.estimate.push_back({stamp_ns + 1'000'000, seen * truth});
  }
  // Without ground truth for some.
  pair.truth.erase(pair.truth.begin() + 40, pair.truth.begin() + 60);
  return pair;
}

void expect_same_bits(const Statistics& a, const Statistics& b, const std::string& what) {
  for (const auto value : {&Statistics::rmse, &Statistics::mean, &Statistics::median, &Statistics::std,
                           &Statistics::min, &Statistics::max, &Statistics::sse})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.*value), std::bit_cast<std::uint64_t>(b.*value))
        << what << ": " << a.*value << " and " << b.*value;
  EXPECT_EQ(a.count, b.count) << what;
}

TEST(StreamedStatistics, AreThoseOfAList) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> spread(0, 3);
  for (const std::size_t count : {1, 2, 3, 4, 5, 100, 101, 5000, 5001}) {
    for (const int kind : {0, 1, 2, 3}) {
      std::vector<double> values;
      for (std::size_t i = 0; i < count; ++i) {
        const double x = spread(random);
        // Positive, of either sign, with many equal ones, and over all exponents.
        values.push_back(kind == 0   ? std::abs(x)
                         : kind == 1 ? x
                         : kind == 2 ? std::round(x) + 10
                                     : std::exp(30 * x));
      }
      int passes = 0;
      const Statistics streamed = streamed_statistics([&](const ValueVisitor& visit) {
        ++passes;
        for (const double value : values) visit(value);
      });
      EXPECT_EQ(passes, 4);
      expect_same_bits(streamed, statistics(values),
                       std::to_string(count) + " of kind " + std::to_string(kind));
    }
  }
  EXPECT_EQ(streamed_statistics([](const ValueVisitor&) {}).count, 0U);
  EXPECT_TRUE(std::isnan(streamed_statistics([](const ValueVisitor&) {}).median));
}

TrajectoryRequest every_pose_to_every_pose() {
  TrajectoryRequest request = request_for(Protocol::tum, TrajectoryMetric::rpe).value();
  request.motions = MotionRule::each_to_each;
  return request;
}

TrajectoryRequest all_turns(PoseRelation relation) {
  TrajectoryRequest request = request_for(Protocol::evo, TrajectoryMetric::rpe).value();
  request.motions = MotionRule::all;
  request.delta = {40, DeltaUnit::degrees};
  request.delta_tolerance = 1;
  request.relation = relation;
  return request;
}

TEST(ManyMotions, HaveTheNumbersOfAList) {
  const Pair pair = wandering(150);
  for (const TrajectoryRequest& listed :
       {every_pose_to_every_pose(), all_turns(PoseRelation::translation), all_turns(PoseRelation::angle_deg),
        all_turns(PoseRelation::distance_error_ratio)}) {
    TrajectoryRequest streamed = listed;
    streamed.listing.most = 1000;
    auto list = evaluate(pair.truth, pair.estimate, listed);
    auto stream = evaluate(pair.truth, pair.estimate, streamed);
    ASSERT_TRUE(list && stream);
    ASSERT_EQ(list->series.size(), stream->series.size());
    EXPECT_EQ(list->pairs, stream->pairs);
    EXPECT_EQ(list->possible, stream->possible);
    for (std::size_t k = 0; k < list->series.size(); ++k) {
      const ErrorSeries& a = list->series[k];
      ErrorSeries& b = stream->series[k];
      EXPECT_GT(a.errors.size(), 1000U);
      EXPECT_FALSE(a.streamed);
      EXPECT_TRUE(b.errors.empty() && b.at_ns.empty());
      ASSERT_TRUE(b.streamed);
      expect_same_bits(a.stats, b.stats, a.relation);
      std::vector<double> again;
      b.streamed([&](double error) { again.push_back(error); });
      EXPECT_EQ(again, a.errors) << a.relation << ": another order or other errors";
    }
    ErrorSeries& first = list->series[0];
    const std::string unit = first.unit == "m" ? "mm" : first.unit == "deg" ? "rad" : "";
    if (unit.empty()) continue;
    ASSERT_TRUE(change_unit(first, unit) && change_unit(stream->series[0], unit));
    EXPECT_EQ(stream->series[0].unit, unit);
    expect_same_bits(first.stats, stream->series[0].stats, unit);
  }
}

TEST(ManyMotions, AreRefusedWhereAListIsNeeded) {
  const Pair pair = wandering(150);
  for (TrajectoryRequest request : {every_pose_to_every_pose(), all_turns(PoseRelation::translation)}) {
    request.listing = {1000, true};
    const auto refused = evaluate(pair.truth, pair.estimate, request);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
    EXPECT_NE(refused.error().message.find("motions are too many to list"), std::string::npos);
    request.listing.most = 150 * 150;
    const auto listed = evaluate(pair.truth, pair.estimate, request);
    ASSERT_TRUE(listed.has_value());
    EXPECT_FALSE(listed->series[0].errors.empty());
  }
  const auto sentence = check_listing({.needed = true}, 100'000'000);
  ASSERT_FALSE(sentence.has_value());
  EXPECT_NE(sentence.error().message.find("100000000 motions"), std::string::npos);
  EXPECT_NE(sentence.error().message.find("7.5 GB"), std::string::npos) << sentence.error().message;
}

TEST(ManyMotions, TakeLittleMemory) {
  // 6.8 million motions, whose errors alone would take 54 MB.
  const Pair pair = wandering(2600);
  constexpr std::size_t kMost = 40u << 20;
  for (const TrajectoryRequest& request :
       {every_pose_to_every_pose(), all_turns(PoseRelation::translation)}) {
    TrajectoryRequest given = request;
    if (given.protocol == Protocol::evo) given.listing.most = 1'000'000;
    const auto child = testing::run_in_child(kMost, [&] {
      const auto result = evaluate(pair.truth, pair.estimate, given);
      if (!result) return result.error().message;
      return std::string(result->series[0].stats.count > given.listing.most ? "many" : "few");
    });
    EXPECT_TRUE(child.ended_well);
    EXPECT_EQ(child.text, "many") << "a limit of " << kMost << " bytes was met, or there were few motions";
  }
}

// The definitions, pose by pose.
IndexPairs every_turn(const Trajectory& trajectory, double least_rad, double most_rad) {
  IndexPairs pairs;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    for (std::size_t j = i + 1; j < trajectory.size(); ++j) {
      const double angle_rad =
          rotation_angle_rad(trajectory[i].T_world_camera.rotation, trajectory[j].T_world_camera.rotation);
      if (angle_rad >= least_rad && angle_rad <= most_rad) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

IndexPairs every_rpg_segment(const Trajectory& trajectory, double length_m) {
  const std::vector<double> path_m = path_lengths(trajectory);
  IndexPairs pairs;
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    double least_m = 0.2 * length_m;
    std::size_t best = path_m.size();
    for (std::size_t j = i; j < path_m.size(); ++j) {
      const double miss_m = std::abs(path_m[j] - (path_m[i] + length_m));
      if (miss_m < least_m) {
        least_m = miss_m;
        best = j;
      }
    }
    if (best < path_m.size()) pairs.emplace_back(i, best);
  }
  return pairs;
}

TEST(ManyMotions, AreFoundWithoutLookingAtAllPairs) {
  Trajectory trajectory = wandering(1500).estimate;
  // It stands still for a while: many poses of one path and one direction.
  for (std::size_t i = 200; i < 260; ++i) trajectory[i].T_world_camera = trajectory[200].T_world_camera;
  for (const double delta_deg : {0.5, 10.0, 60.0, 170.0}) {
    for (const double tolerance : {0.01, 0.1, 1.0}) {
      const double delta_rad = radians(delta_deg);
      const IndexPairs wanted =
          every_turn(trajectory, delta_rad - tolerance * delta_rad, delta_rad + tolerance * delta_rad);
      IndexPairs found;
      const std::size_t compared =
          visit_turns(trajectory, {delta_deg, DeltaUnit::degrees}, tolerance, 10'000'000,
                      [&](std::size_t i, std::size_t j) { found.emplace_back(i, j); });
      EXPECT_EQ(found, wanted) << delta_deg << " deg, " << tolerance;
      constexpr std::size_t kAll = 1500 * 1499 / 2;
      EXPECT_LE(compared, kAll);
      // Of a tolerance of all of delta, most pairs fit.
      if (tolerance < 1) {
        EXPECT_LT(compared, kAll) << delta_deg << " deg, " << tolerance;
      }
    }
  }
  for (const double length_m : {0.001, 0.5, 4.0, 30.0, 70.0, 1000.0})
    EXPECT_EQ(rpg_motions(trajectory, length_m, false), every_rpg_segment(trajectory, length_m)) << length_m;
}

TEST(ManyMotions, OfMorePairsThanCanBeLookedAtAreRefused) {
  const Pair pair = wandering(150);
  for (TrajectoryRequest request : {every_pose_to_every_pose(), all_turns(PoseRelation::translation)}) {
    request.listing = {.most = 10, .needed = false, .most_compared = 2000};
    const auto refused = evaluate(pair.truth, pair.estimate, request);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
    EXPECT_NE(refused.error().message.find("(allowed: up to 2000)"), std::string::npos)
        << refused.error().message;
  }
}

TEST(MotionDelta, HasAnUpperLimit) {
  for (const DeltaUnit unit : {DeltaUnit::frames, DeltaUnit::metres, DeltaUnit::seconds}) {
    EXPECT_TRUE(check_delta({1e9, unit}));
    EXPECT_FALSE(check_delta({1e10, unit}));
    EXPECT_FALSE(check_delta({1e308, unit}));
  }
}

}  // namespace
}  // namespace fusebench
