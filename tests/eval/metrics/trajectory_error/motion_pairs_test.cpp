// Which pose is taken where two are as near: delta and paths are binary fractions, so that ties are exact.
#include "eval/metrics/trajectory_error/motion_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fusebench {

using namespace trajectory_error;

namespace {

constexpr DeltaUnit kMetres = DeltaUnit::metres;
constexpr DeltaUnit kSeconds = DeltaUnit::seconds;

/// Poses on a straight line; their times in seconds are their places in metres.
Trajectory on_a_line(const std::vector<double>& places) {
  Trajectory trajectory;
  for (const double place : places) {
    trajectory.push_back({static_cast<std::int64_t>(std::llround(1e9 * place)),
                          SE3{Quaterniond::Identity(), Vector3d(place, 0, 0)}});
  }
  return trajectory;
}

// evo: numpy.argmin(abs(path - delta)) over the later poses, which is the first of equal ones.
TEST(MotionPairs, AllPairsTakeTheEarlierOfTwoPosesAsNear) {
  const Delta two_metres{2.0, kMetres};
  for (const DeltaUnit unit : {kMetres, kSeconds}) {
    // From 0, both 1 and 3 are 1 from 2; from 1 on, nothing is within half of 2.
    EXPECT_EQ(all_motions(on_a_line({0, 1, 3}), {2.0, unit}, 0.5), (IndexPairs{{0, 1}, {1, 2}}));
    // The same with more poses before the first and behind the second of them.
    EXPECT_EQ(all_motions(on_a_line({0, 0.25, 1, 3, 64, 128}), {2.0, unit}, 0.5),
              (IndexPairs{{0, 2}, {1, 3}, {2, 3}}));
  }
  // Several poses at one place: the first of them, on either side of delta.
  EXPECT_EQ(all_motions(on_a_line({0, 1, 1, 1, 3, 3}), two_metres, 0.5),
            (IndexPairs{{0, 1}, {1, 4}, {2, 4}, {3, 4}}));
  EXPECT_EQ(all_motions(on_a_line({0, 1.5, 2.25, 2.25}), {2.0, kMetres}, 0.125), (IndexPairs{{0, 2}}));
}

TEST(MotionPairs, AllPairsIncludeTheTolerance) {
  EXPECT_EQ(all_motions(on_a_line({0, 1.5}), {2.0, kMetres}, 0.25), (IndexPairs{{0, 1}}));
  EXPECT_EQ(all_motions(on_a_line({0, 1.4375}), {2.0, kMetres}, 0.25), IndexPairs{});
}

TEST(MotionPairs, ConsecutiveMotionsEndWhereTheDeltaIsReached) {
  // Reached exactly counts. Metres begin at the first mark, seconds at the first pose.
  EXPECT_EQ(consecutive_motions(on_a_line({0, 0.5, 1, 1.5, 2, 2.75}), {1.0, kMetres}), (IndexPairs{{2, 4}}));
  EXPECT_EQ(consecutive_motions(on_a_line({0, 0.5, 1, 1.5, 2, 2.75}), {1.0, kSeconds}),
            (IndexPairs{{0, 2}, {2, 4}}));
}

/// find_closest_index() of TUM's evaluate_rpe.py, line by line.
std::size_t closest_index(const std::vector<double>& list, double wanted) {
  std::size_t beginning = 0;
  double difference = std::abs(list[0] - wanted);
  std::size_t best = 0;
  std::size_t end = list.size();
  while (beginning < end) {
    const std::size_t middle = (end + beginning) / 2;
    if (std::abs(list[middle] - wanted) < difference) {
      difference = std::abs(list[middle] - wanted);
      best = middle;
    }
    if (wanted == list[middle]) return middle;
    if (list[middle] > wanted) {
      end = middle;
    } else {
      beginning = middle + 1;
    }
  }
  return best;
}

TEST(MotionPairs, FixedDeltaTakesTheFirstThatTheBisectionMeets) {
  // Of the poses at 1 and 3, the bisection of six poses meets 3 first, that of four poses 1.
  const std::vector<double> long_list = {0, 0.25, 1, 3, 8, 16};
  const std::vector<double> short_list = {0, 1, 3, 8};
  EXPECT_EQ(closest_index(long_list, 2.0), 3U);
  for (const std::vector<double>& places : {long_list, short_list}) {
    for (const double delta : {0.5, 1.0, 2.0, 4.0}) {
      IndexPairs wanted;
      for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t j = closest_index(places, places[i] + delta);
        if (j + 1 != places.size()) wanted.emplace_back(i, j);
      }
      EXPECT_EQ(tum_motions(on_a_line(places), {delta, kMetres}), wanted) << delta;
      EXPECT_EQ(tum_motions(on_a_line(places), {delta, kSeconds}), wanted) << delta;
    }
  }
  EXPECT_EQ(tum_motions(on_a_line(long_list), {2.0, kSeconds}).front(), (IndexPairs::value_type{0, 3}));
}

// rpg_trajectory_evaluation keeps the first of the least differences, and refuses a fifth of the length.
TEST(MotionPairs, SegmentsOfRpgTakeTheEarlierOfTwoPosesAsNear) {
  EXPECT_EQ(rpg_motions(on_a_line({0, 0.875, 1.125, 64}), 1.0, false), (IndexPairs{{0, 1}}));
  EXPECT_EQ(rpg_motions(on_a_line({0, 0.875, 0.875, 1.125, 1.125}), 1.0, false), (IndexPairs{{0, 1}}));
  EXPECT_EQ(rpg_motions(on_a_line({0, 4, 4}), 5.0, false), IndexPairs{});
  EXPECT_EQ(rpg_motions(on_a_line({0, 4.0625, 4.0625}), 5.0, false), (IndexPairs{{0, 1}}));
}

}  // namespace
}  // namespace fusebench
