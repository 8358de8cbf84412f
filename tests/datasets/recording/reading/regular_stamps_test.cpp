#include "datasets/recording/reading/regular_stamps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include "datasets/recording/reading/image_list.hpp"

namespace fusebench {

using namespace reading;

namespace {

using Stamps = std::vector<std::int64_t>;

constexpr std::int64_t kPeriod_ns = 33'366'700;             // 29.97 Hz
constexpr std::int64_t kStart_ns = 1305031102'000'000'000;  // as large as real stamps
constexpr double kJitter_ns = 5e6;                          // largest; a real Kinect has 4.7 ms
constexpr std::size_t kNearEnd = 15;                        // frames without half a second on either side
const double kUniformRms_ns = kJitter_ns / std::numbers::sqrt3;  // of jitter uniform in +-kJitter_ns

/// When a camera of constant rate exposes the frames of the given numbers.
Stamps exposures(std::size_t count, const std::function<bool(std::size_t)>& dropped = {}) {
  Stamps times;
  for (std::size_t number = 0; times.size() < count; ++number) {
    if (dropped && dropped(number)) continue;
    times.push_back(kStart_ns + static_cast<std::int64_t>(number) * kPeriod_ns);
  }
  return times;
}

/// Stamps of these times that are off by +-kJitter_ns, uniform and independent.
Stamps jittered(Stamps times, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  for (std::int64_t& time : times) {
    const double unit = static_cast<double>(engine() >> 11) * 0x1p-53;  // the same with every library
    time += std::llround((2 * unit - 1) * kJitter_ns);
  }
  return times;
}

struct Errors {
  double rms_ns = 0;
  double max_ns = 0;
};

/// Of captures against true times, leaving out `margin` frames at either end.
Errors errors_of(const Stamps& captures, const Stamps& truth, std::size_t margin) {
  Errors errors;
  double squares = 0;
  for (std::size_t i = margin; i + margin < truth.size(); ++i) {
    const double error = static_cast<double>(captures[i] - truth[i]);
    squares += error * error;
    errors.max_ns = std::max(errors.max_ns, std::abs(error));
  }
  errors.rms_ns = std::sqrt(squares / static_cast<double>(truth.size() - 2 * margin));
  return errors;
}

bool strictly_increasing(const Stamps& times) {
  return std::ranges::adjacent_find(times, std::ranges::greater_equal()) == times.end();
}

/// The value at the middle of a line through 31 stamps is their mean, with jitter / sqrt(31); at an end, a
/// line through 16 stamps has 2 * jitter / sqrt(16). Neighbouring errors share stamps, hence some slack.
void expect_averaged(const Stamps& captures, const Stamps& truth) {
  const Errors middle = errors_of(captures, truth, kNearEnd);
  EXPECT_LT(middle.rms_ns, 1.3 * kUniformRms_ns / std::sqrt(31.0));
  EXPECT_LT(middle.max_ns, 4 * kUniformRms_ns / std::sqrt(31.0));
  EXPECT_LT(errors_of(captures, truth, 0).rms_ns, 0.3 * kUniformRms_ns);
}

TEST(RegularStamps, RegularOnesStay) {
  const Stamps times = exposures(100);
  const auto regular = regular_stamps(times);
  ASSERT_TRUE(regular);
  EXPECT_LE(errors_of(regular->capture_ns, times, 0).max_ns, 1);
  EXPECT_LT(regular->jitter_max_s, 1e-9);
}

TEST(RegularStamps, RandomJitterIsAveragedAway) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Stamps truth = exposures(600);
    const auto regular = regular_stamps(jittered(truth, seed));
    ASSERT_TRUE(regular) << seed;
    EXPECT_TRUE(strictly_increasing(regular->capture_ns));
    expect_averaged(regular->capture_ns, truth);
    // What is reported is what was planted, within the sampling error of 600 values.
    EXPECT_NEAR(regular->jitter_rms_s, 1e-9 * kUniformRms_ns, 0.1e-9 * kUniformRms_ns);
    EXPECT_GT(regular->jitter_max_s, 0.9e-9 * kJitter_ns);
  }
}

/// Single intervals are then of two kinds (or three, when jitter comes in pairs), and the longest is almost
/// twice the shortest.
TEST(RegularStamps, AlternatingJitterDoesNotDecideThePeriod) {
  for (const std::size_t run : {1U, 2U}) {  // stamps in a row that jitter the same way
    for (const std::size_t count : {100U, 101U, 102U, 103U}) {
      for (const std::size_t first : {0U, 1U, 2U, 3U}) {
        const Stamps truth = exposures(count);
        Stamps stamps = truth;
        for (std::size_t i = 0; i < count; ++i) {
          stamps[i] += ((i + first) / run % 2 == 0 ? 1 : -1) * std::llround(kJitter_ns);
        }
        const auto regular = regular_stamps(stamps);
        ASSERT_TRUE(regular) << run << " " << count << " " << first;
        // All but one of 31 alternating values cancel, whether single or in pairs.
        EXPECT_LT(errors_of(regular->capture_ns, truth, kNearEnd).max_ns, 1.01 * kJitter_ns / 31)
            << run << " " << count << " " << first;
        EXPECT_NEAR(regular->jitter_rms_s, 1e-9 * kJitter_ns, 0.1e-9 * kJitter_ns);
      }
    }
  }
}

TEST(RegularStamps, DroppedFramesDoNoHarm) {
  // Gaps of two periods at 100, 107, 300 and of five at 200 and 400.
  const auto dropped = [](std::size_t number) {
    return number == 100 || number == 107 || number == 300 || (number >= 200 && number < 204) ||
           (number >= 400 && number < 404);
  };
  const Stamps truth = exposures(600, dropped);
  ASSERT_EQ(truth[100] - truth[99], 2 * kPeriod_ns);
  const auto exact = regular_stamps(truth);
  ASSERT_TRUE(exact);
  EXPECT_LE(errors_of(exact->capture_ns, truth, 0).max_ns, 1);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto regular = regular_stamps(jittered(truth, seed));
    ASSERT_TRUE(regular) << seed;
    EXPECT_TRUE(strictly_increasing(regular->capture_ns));
    expect_averaged(regular->capture_ns, truth);
  }
}

TEST(RegularStamps, ManyDroppedFramesDoNoHarm) {
  std::mt19937_64 engine(1);
  const Stamps truth = exposures(600, [&](std::size_t) { return engine() % 5 == 0; });
  const auto regular = regular_stamps(jittered(truth, 2));
  ASSERT_TRUE(regular);
  EXPECT_TRUE(strictly_increasing(regular->capture_ns));
  // A fifth less stamps to average.
  EXPECT_LT(errors_of(regular->capture_ns, truth, kNearEnd).rms_ns,
            1.3 * kUniformRms_ns / std::sqrt(0.8 * 31.0));
}

TEST(RegularStamps, ASlowClockDriftIsFollowed) {
  // The rate of the stamping clock swings by +-100 ppm in 200 s, which moves its time by 3.2 ms: no single
  // line fits. Over the half second on either side the rate bends by 3e-6 / s, that is 0.4 us.
  constexpr double kRate = 1e-4;
  constexpr double kSwing_radps = 2 * std::numbers::pi / 200;
  Stamps truth = exposures(6000);
  for (std::int64_t& time : truth) {
    const double t_s = 1e-9 * static_cast<double>(time - kStart_ns);
    time += std::llround(1e9 * kRate / kSwing_radps * (1 - std::cos(kSwing_radps * t_s)));
  }
  const auto exact = regular_stamps(truth);
  ASSERT_TRUE(exact);
  EXPECT_LT(errors_of(exact->capture_ns, truth, 0).max_ns, 1000);
  const auto regular = regular_stamps(jittered(truth, 1));
  ASSERT_TRUE(regular);
  EXPECT_TRUE(strictly_increasing(regular->capture_ns));
  EXPECT_LT(errors_of(regular->capture_ns, truth, kNearEnd).rms_ns, 1.3 * kUniformRms_ns / std::sqrt(31.0));

  // A constant 100 ppm: 20 ms at the end of 200 s.
  Stamps fast = exposures(6000);
  for (std::int64_t& time : fast) time += (time - kStart_ns) / 10'000;
  EXPECT_LE(errors_of(regular_stamps(fast)->capture_ns, fast, 0).max_ns, 2);
}

TEST(RegularStamps, TooFewStampsAreLeftAlone) {
  for (const std::size_t count : {0U, 1U, 2U, 9U}) EXPECT_FALSE(regular_stamps(exposures(count))) << count;
  EXPECT_TRUE(regular_stamps(exposures(10)));
}

TEST(RegularStamps, AnIrregularListIsRefused) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    Stamps stamps = {kStart_ns};
    for (int i = 1; i < 200; ++i) {  // gaps of 10 to 110 ms
      stamps.push_back(stamps.back() + 10'000'000 + static_cast<std::int64_t>(engine() % 100'000'000));
    }
    EXPECT_FALSE(regular_stamps(stamps)) << seed;
  }
}

TEST(RegularStamps, JitterOfARealKinect) {
  const char* const data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "FUSEBENCH_DATA is not set";
  const auto list = std::filesystem::path(data) / "rgbd_dataset_freiburg1_rpy_first240" / "rgb.txt";
  if (!std::filesystem::exists(list)) GTEST_SKIP() << list << " does not exist";
  std::vector<std::string> warnings;
  const auto images = read_image_list(list, warnings);
  ASSERT_TRUE(images) << images.error().message;
  Stamps stamps;
  for (const ListedImage& image : *images) stamps.push_back(image.timestamp_ns);
  const auto regular = regular_stamps(stamps);
  ASSERT_TRUE(regular);
  EXPECT_TRUE(strictly_increasing(regular->capture_ns));
  EXPECT_NEAR(regular->jitter_rms_s, 1.8e-3, 0.3e-3);
  EXPECT_LT(regular->jitter_max_s, 0.01);
}

}  // namespace
}  // namespace fusebench
