#include "core/estimator/places/relocalisation/keyframes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/base/error.hpp"
#include "core/config/config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace places;
using namespace relocalisation;

namespace {

using config::Config;
using testing::small_camera;
using testing::TexturedRoom;

constexpr Config kDefaults{};

RgbdFrame seen_from(const SE3& T_world_camera) {
  return TexturedRoom{}.render(small_camera(), T_world_camera, 0);
}

void offer(Keyframes& keyframes, const SE3& T_world_camera, std::int64_t timestamp_ns = 0) {
  const RgbdFrame frame = seen_from(T_world_camera);
  keyframes.offer(frame.grey, frame.depth_m, T_world_camera, timestamp_ns);
}

/// A keyframe in the middle of the room.
Keyframes one_keyframe(const SE3& T_world_camera = {}) {
  Keyframes keyframes(small_camera(), kDefaults);
  offer(keyframes, T_world_camera);
  return keyframes;
}

/// Result of a search.
std::optional<FoundPlace> first_of(const std::vector<FoundPlace>& best_first) {
  if (best_first.empty()) return std::nullopt;
  return best_first.front();
}

GreyImage noise_image() {
  std::mt19937 random(3);
  GreyImage grey(320, 240);
  for (std::uint8_t& level : grey.data) level = static_cast<std::uint8_t>(random() & 255U);
  return grey;
}

TEST(Keyframes, FindThePoseOfAFrameThatIsAside) {
  // The world frame differs from that of the keyframe, so that confused frames are detected.
  const SE3 T_world_room{so3_exp({0.4, -1.1, 0.7}), {3, -2, 5}};
  const SE3 T_room_key{so3_exp({0.05, -0.1, 0.02}), {0.05, 0, -0.1}};
  const RgbdFrame key = seen_from(T_room_key);
  Keyframes keyframes(small_camera(), kDefaults);
  ASSERT_TRUE(keyframes.offer(key.grey, key.depth_m, T_world_room * T_room_key, 0));
  const double turn_rad = radians(15);
  const SE3 asides[] = {
      {Quaterniond::Identity(), Vector3d::Zero()},
      {so3_exp({0, turn_rad, 0}), {-0.2, 0, 0}},
      {so3_exp({0, -turn_rad, 0}), {0.14, 0.14, 0}},
      {so3_exp({turn_rad, 0, 0}), {0, 0, -0.2}},
      {so3_exp({0, 0, turn_rad}), {0.1, -0.1, 0.14}},
      {so3_exp({0, 0, radians(100)}), {0.02, 0, 0}},  // upright or on its side
  };
  for (const SE3& T_key_query : asides) {
    const auto found = first_of(keyframes.find(seen_from(T_room_key * T_key_query).grey));
    ASSERT_TRUE(found) << so3_log(T_key_query.rotation).transpose();
    const SE3 T_world_query = T_world_room * T_room_key * T_key_query;
    EXPECT_LT((found->T_world_camera.translation - T_world_query.translation).norm(), 0.02);
    EXPECT_LT(rotation_angle_rad(found->T_world_camera.rotation, T_world_query.rotation), radians(1));
    EXPECT_LE(found->inliers, found->matches);
    EXPECT_LT(found->rms_px, 3.0);
  }
}

TEST(Keyframes, TheCovarianceTurnsWithTheWorld) {
  // Rotated worlds, so that the axes of the covariance matter.
  const SE3 T_world_room{so3_exp({0, 0, radians(90)}), {1, 2, 3}};
  const RgbdFrame key = seen_from({});
  Keyframes plain(small_camera(), kDefaults);
  Keyframes turned(small_camera(), kDefaults);
  plain.offer(key.grey, key.depth_m, SE3{}, 0);
  turned.offer(key.grey, key.depth_m, T_world_room, 0);
  const GreyImage query = seen_from({so3_exp({0, 0.1, 0}), {-0.1, 0, 0}}).grey;
  const auto a = first_of(plain.find(query));
  const auto b = first_of(turned.find(query));
  ASSERT_TRUE(a && b);
  const Matrix3d R = T_world_room.rotation_matrix();
  const Matrix6d& cov_a = a->covariance;
  const Matrix6d& cov_b = b->covariance;
  const double size = cov_a.norm();
  EXPECT_LT((cov_b.topLeftCorner<3, 3>() - cov_a.topLeftCorner<3, 3>()).norm(), 1e-9 * size);
  const Matrix3d turned_position = R * cov_a.bottomRightCorner<3, 3>() * R.transpose();
  EXPECT_LT((cov_b.bottomRightCorner<3, 3>() - turned_position).norm(), 1e-9 * size);
  EXPECT_GT((cov_b - cov_a).norm(), 1e-3 * size) << "the axes make no difference: the test is empty";
}

/// Towards a corner of the room, so that surfaces face all directions.
const SE3 kCorner{so3_exp({-0.45, 0.6, 0}), {0, 0, 0}};

TEST(Keyframes, DepthFindsThePoseInTheDark) {
  const SE3 T_world_room{so3_exp({0.4, -1.1, 0.7}), {3, -2, 5}};
  const RgbdFrame key = seen_from(kCorner);
  Keyframes keyframes(small_camera(), kDefaults);
  ASSERT_TRUE(keyframes.offer(key.grey, key.depth_m, T_world_room * kCorner, 0));
  const SE3 truth = T_world_room * kCorner * SE3{so3_exp({0.05, 0.1, -0.05}), {0.1, -0.05, 0.05}};
  const SE3 predicted = pose_plus(truth, (Vector6d() << 0.03, -0.03, 0.02, 0.04, 0.02, -0.03).finished());
  RgbdFrame query = seen_from(T_world_room.inverse() * truth);
  std::fill(query.grey.data.begin(), query.grey.data.end(), std::uint8_t{2});
  ASSERT_TRUE(keyframes.find(query.grey).empty()) << "features alone would do: the test is empty";
  const auto found =
      first_of(keyframes.find_by_depth(places::small_images_of(query.grey, query.depth_m), predicted, 0));
  ASSERT_TRUE(found);
  EXPECT_LT((found->T_world_camera.translation - truth.translation).norm(), 0.006);
  EXPECT_LT(rotation_angle_rad(found->T_world_camera.rotation, truth.rotation), radians(0.3));
  EXPECT_EQ(found->inliers, 0);
}

TEST(Keyframes, DepthFindsAPlaceWithoutAPrediction) {
  const RgbdFrame key = seen_from(kCorner);
  Keyframes keyframes(small_camera(), kDefaults);
  ASSERT_TRUE(keyframes.offer(key.grey, key.depth_m, kCorner, 0));
  const SE3 truth = kCorner * SE3{so3_exp({0.03, 0.06, -0.04}), {0.08, -0.05, 0.05}};
  RgbdFrame query = seen_from(truth);
  std::fill(query.grey.data.begin(), query.grey.data.end(), std::uint8_t{2});
  const SE3 lost{so3_exp({0, radians(170), 0}), {2, 0, 1}};
  const auto found =
      first_of(keyframes.find_by_depth(places::small_images_of(query.grey, query.depth_m), lost, 0.5));
  ASSERT_TRUE(found);
  EXPECT_LT((found->T_world_camera.translation - truth.translation).norm(), 0.006);
  EXPECT_LT(rotation_angle_rad(found->T_world_camera.rotation, truth.rotation), radians(0.3));
}

TEST(Keyframes, DepthOfAnotherPlaceFindsNothing) {
  const RgbdFrame key = seen_from(kCorner);
  Keyframes keyframes(small_camera(), kDefaults);
  ASSERT_TRUE(keyframes.offer(key.grey, key.depth_m, kCorner, 0));
  const auto of = [](const RgbdFrame& frame) { return places::small_images_of(frame.grey, frame.depth_m); };
  const SE3 turned = kCorner * SE3{so3_exp({0, radians(150), 0}), Vector3d::Zero()};
  EXPECT_TRUE(keyframes.find_by_depth(of(seen_from(turned)), turned, 0.5).empty())
      << "it shares nothing with the keyframe";
  EXPECT_TRUE(keyframes.find_by_depth(of(seen_from(turned)), kCorner, 0.5).empty())
      << "neither the prediction nor what it looks like is of this place";
}

TEST(Keyframes, ReturnTheMatchedKeyframe) {
  Keyframes keyframes(small_camera(), kDefaults);
  const SE3 front;
  const SE3 left{so3_exp({0, radians(-80), 0}), Vector3d::Zero()};
  const SE3 right{so3_exp({0, radians(80), 0}), Vector3d::Zero()};
  offer(keyframes, front, 10);
  offer(keyframes, left, 20);
  offer(keyframes, right, 30);
  ASSERT_EQ(keyframes.size(), 3U);
  const SE3 aside{so3_exp({0.03, 0.05, 0}), {0.05, 0, 0}};
  std::size_t expected = 0;
  for (const SE3& base : {front, left, right}) {
    const auto found = first_of(keyframes.find(seen_from(base * aside).grey));
    ASSERT_TRUE(found) << expected;
    EXPECT_EQ(found->keyframe, expected++);
  }
  EXPECT_EQ(keyframes[1].timestamp_ns, 20);
}

TEST(Keyframes, FindThePlaceAmongMoreThanAreMatchedWithAllFeatures) {
  constexpr int kDirections = 32;
  static_assert(kDirections > config::RelocalisationConfig::max_candidates);
  Config config;
  config.relocalisation.keyframe_angle_deg = 10;
  Keyframes keyframes(small_camera(), config);
  const auto T_room_direction = [](int direction) {
    return SE3{so3_exp({0, radians(360.0 * direction / kDirections), 0}), {0, 0, 0}};
  };
  for (int direction = 0; direction < kDirections; ++direction)
    offer(keyframes, T_room_direction(direction), direction);
  ASSERT_GT(keyframes.size(), static_cast<std::size_t>(config::RelocalisationConfig::max_candidates));
  int found_alone = 0;
  for (int direction = 0; direction < kDirections; direction += 3) {
    const SE3 T_room_query = T_room_direction(direction) * SE3{so3_exp({0.03, 0.02, 0.05}), {0.05, 0, 0.05}};
    const GreyImage query = seen_from(T_room_query).grey;
    if (one_keyframe(T_room_direction(direction)).find(query).empty()) continue;
    ++found_alone;
    const auto found = first_of(keyframes.find(query));
    ASSERT_TRUE(found) << direction;
    EXPECT_LT((found->T_world_camera.translation - T_room_query.translation).norm(), 0.02) << direction;
  }
  EXPECT_GE(found_alone, 5);
}

TEST(Keyframes, ReturnAllAmbiguousCandidates) {
  // Two doors of a corridor: the same picture, three metres apart.
  const RgbdFrame door = seen_from({});
  const SE3 next_door{Quaterniond::Identity(), {3, 0, 0}};
  Keyframes keyframes(small_camera(), kDefaults);
  ASSERT_TRUE(keyframes.offer(door.grey, door.depth_m, {}, 1));
  ASSERT_TRUE(keyframes.offer(door.grey, door.depth_m, next_door, 2));
  const SE3 back{so3_exp({0, radians(180), 0}), Vector3d::Zero()};
  offer(keyframes, back, 3);
  const SE3 aside{so3_exp({0, 0.1, 0}), {-0.1, 0, 0}};
  const std::vector<FoundPlace> found = keyframes.find(seen_from(aside).grey);
  ASSERT_EQ(found.size(), 2U);
  for (const FoundPlace& place : found) {
    const SE3 expected = keyframes[place.keyframe].T_world_camera * aside;
    EXPECT_LT((place.T_world_camera.translation - expected.translation).norm(), 0.02);
    EXPECT_EQ(place.support, place.inliers);
  }
  EXPECT_NE(found[0].keyframe, found[1].keyframe);
}

TEST(Keyframes, FindNothingInAnUnvisitedPlace) {
  Keyframes keyframes = one_keyframe();
  ASSERT_EQ(keyframes.size(), 1U);
  EXPECT_FALSE(keyframes.find(seen_from({}).grey).empty()) << "else the rest says nothing";
  const SE3 back{so3_exp({0, radians(180), 0}), Vector3d::Zero()};
  EXPECT_TRUE(keyframes.find(seen_from(back).grey).empty());
  const SE3 side{so3_exp({0, radians(100), 0}), Vector3d::Zero()};
  EXPECT_TRUE(keyframes.find(seen_from(side).grey).empty());
  EXPECT_TRUE(keyframes.find(GreyImage(320, 240, 0)).empty());
  EXPECT_TRUE(keyframes.find(GreyImage(320, 240, 140)).empty());
  EXPECT_TRUE(keyframes.find(noise_image()).empty());
}

TEST(Keyframes, ASmallPartOfAnImageIsNotAPlace) {
  // A poster may be in two rooms: matches in one corner of the image determine no pose.
  Keyframes keyframes = one_keyframe();
  const GreyImage whole = seen_from({}).grey;
  GreyImage corner(320, 240, 140);
  for (int y = 60; y < 180; ++y) {
    for (int x = 160; x < 300; ++x) corner(x, y) = whole(x, y);
  }
  const std::size_t seen = find_place_features(corner, kDefaults.place_features).size();
  ASSERT_GE(seen, 100U) << "it must not be for want of features";
  EXPECT_TRUE(keyframes.find(corner).empty());
}

TEST(Keyframes, AnEmptyStoreFindsNothing) {
  Keyframes keyframes(small_camera(), kDefaults);
  EXPECT_EQ(keyframes.size(), 0U);
  EXPECT_TRUE(keyframes.find(seen_from({}).grey).empty());
}

TEST(Keyframes, AStillCameraAddsOneAndAMovingOneMore) {
  Keyframes still(small_camera(), kDefaults);
  Keyframes moving(small_camera(), kDefaults);
  Keyframes turning(small_camera(), kDefaults);
  Keyframes rolling(small_camera(), kDefaults);
  for (int k = 0; k < 13; ++k) {
    offer(still, {so3_exp({0, 0.01 * (k % 3), 0}), {0.01 * (k % 2), 0, 0}}, k);
    offer(moving, {Quaterniond::Identity(), {-0.48 + 0.08 * k, 0, 0}}, k);
    offer(turning, {so3_exp({0, radians(6.0 * k), 0}), Vector3d::Zero()}, k);
    offer(rolling, {so3_exp({0, 0, radians(6.0 * k)}), Vector3d::Zero()}, k);
  }
  EXPECT_EQ(still.size(), 1U);
  EXPECT_EQ(moving.size(), 4U) << "0, 0.32, 0.64 and 0.96 m";
  EXPECT_EQ(turning.size(), 4U) << "0, 24, 48 and 72 degrees";
  EXPECT_EQ(rolling.size(), 1U);
}

/// Number of kept frames of seven along a line of 0.96 m.
std::size_t kept_along_a_line(const Config& config) {
  Keyframes keyframes(small_camera(), config);
  for (int k = 0; k < 7; ++k) offer(keyframes, {Quaterniond::Identity(), {-0.48 + 0.16 * k, 0, 0}}, k);
  return keyframes.size();
}

TEST(Keyframes, TheSpacingDecidesHowManyAreKept) {
  Config config;
  EXPECT_EQ(kept_along_a_line(config), 4U) << "every second one, 0.32 m apart";
  config.relocalisation.keyframe_distance_m = 0.1;
  EXPECT_EQ(kept_along_a_line(config), 7U);
  config.relocalisation.keyframe_distance_m = 0.45;
  EXPECT_EQ(kept_along_a_line(config), 3U) << "every third one, 0.48 m apart";
  config.relocalisation.keyframe_distance_m = 10;
  EXPECT_EQ(kept_along_a_line(config), 1U);
}

TEST(Keyframes, TheAngleBetweenThemDecidesAsWell) {
  const auto kept = [](double angle_deg) {
    Config config;
    config.relocalisation.keyframe_angle_deg = angle_deg;
    Keyframes keyframes(small_camera(), config);
    for (int k = 0; k < 5; ++k) offer(keyframes, {so3_exp({0, radians(12.0 * k), 0}), Vector3d::Zero()}, k);
    return keyframes.size();
  };
  EXPECT_EQ(kept(10), 5U);
  EXPECT_EQ(kept(20), 3U) << "0, 24 and 48 degrees";
  EXPECT_EQ(kept(90), 1U);
}

TEST(Keyframes, RequireTheConfiguredInliers) {
  Config config;
  const RgbdFrame frame = seen_from({});
  const auto found_with = [&](int min_inliers) {
    config.relocalisation.min_inliers = min_inliers;
    Keyframes keyframes(small_camera(), config);
    EXPECT_TRUE(keyframes.offer(frame.grey, frame.depth_m, {}, 0));
    return first_of(keyframes.find(seen_from({so3_exp({0, 0.1, 0}), {-0.1, 0, 0}}).grey));
  };
  const auto found = found_with(Config{}.relocalisation.min_inliers);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found_with(found->inliers));
  EXPECT_FALSE(found_with(found->inliers + 1));
}

TEST(Keyframes, OfTheCrowdedOneMakesRoomWhenTheStoreIsFull) {
  Config config;
  config.relocalisation.max_keyframes = 3;
  Keyframes keyframes(small_camera(), config);
  const auto turned = [](double degrees) { return SE3{so3_exp({0, radians(degrees), 0}), Vector3d::Zero()}; };
  offer(keyframes, turned(0), 0);
  offer(keyframes, turned(60), 1);
  offer(keyframes, turned(85), 2);
  ASSERT_EQ(keyframes.size(), 3U);
  offer(keyframes, turned(-60), 3);
  ASSERT_EQ(keyframes.size(), 3U);
  EXPECT_EQ(keyframes[0].timestamp_ns, 0);
  EXPECT_EQ(keyframes[1].timestamp_ns, 2) << "25 degrees beside the later one, the nearest of all";
  EXPECT_EQ(keyframes[2].timestamp_ns, 3);
}

TEST(Keyframes, ASharpFrameTakesThePlaceOfABlurredOne) {
  const RgbdFrame frame = seen_from({});
  Keyframes keyframes(small_camera(), kDefaults);
  EXPECT_TRUE(keyframes.offer(frame.grey, frame.depth_m, {}, 1, 8.0));
  EXPECT_FALSE(keyframes.offer(frame.grey, frame.depth_m, {}, 2, 5.0)) << "not much sharper";
  EXPECT_TRUE(keyframes.offer(frame.grey, frame.depth_m, {}, 3, 1.5));
  EXPECT_FALSE(keyframes.offer(frame.grey, frame.depth_m, {}, 4, 0.0)) << "sharp enough already";
  ASSERT_EQ(keyframes.size(), 1U);
  EXPECT_EQ(keyframes[0].timestamp_ns, 3);
}

TEST(Keyframes, MoveWithTheCorrectedPath) {
  Keyframes keyframes(small_camera(), kDefaults);
  offer(keyframes, {}, 7);
  const SE3 T_corrected{so3_exp({0, 0.5, 0}), {1, 2, 3}};
  keyframes.move([&](std::int64_t timestamp_ns) { return timestamp_ns == 7 ? T_corrected : SE3{}; });
  const SE3 T_key_query{so3_exp({0, 0.1, 0}), {0.1, 0, 0}};
  const auto found = first_of(keyframes.find(seen_from(T_key_query).grey));
  ASSERT_TRUE(found);
  EXPECT_LT(pose_minus(found->T_world_camera, T_corrected * T_key_query).norm(), 0.02);
}

TEST(Keyframes, WithoutFeaturesOrDepthAFrameIsNotKept) {
  const RgbdFrame frame = seen_from({});
  Keyframes keyframes(small_camera(), kDefaults);
  EXPECT_FALSE(keyframes.offer(GreyImage(320, 240, 90), frame.depth_m, {}, 0));
  EXPECT_FALSE(keyframes.offer(frame.grey, frame.depth_m, {}, 0)) << "nothing else is tried there";
  const SE3 aside{Quaterniond::Identity(), {1, 0, 0}};
  EXPECT_FALSE(keyframes.offer(frame.grey, DepthImage(320, 240), aside, 1));
  EXPECT_EQ(keyframes.size(), 0U);
  EXPECT_TRUE(keyframes.offer(frame.grey, frame.depth_m, {}, 2)) << "the last barren frame was elsewhere";
}

TEST(Keyframes, ABlurredFrameWithoutFeaturesDoesNotBarASharpOne) {
  const RgbdFrame frame = seen_from({});
  Keyframes keyframes(small_camera(), kDefaults);
  EXPECT_FALSE(keyframes.offer(GreyImage(320, 240, 90), frame.depth_m, {}, 0, 12.0));
  EXPECT_FALSE(keyframes.offer(frame.grey, frame.depth_m, {}, 1, 8.0)) << "not much sharper";
  EXPECT_TRUE(keyframes.offer(frame.grey, frame.depth_m, {}, 2, 1.0));
}

TEST(Keyframes, RejectFeaturesAtAnEdgeOfDepth) {
  RgbdFrame frame = seen_from({});
  for (int y = 0; y < 240; ++y) {
    for (int x = 160; x < 320; ++x) frame.depth_m(x, y) = 0;
    for (int x = 100; x < 160; ++x) frame.depth_m(x, y) = 9;  // behind all else
  }
  const Landmarks landmarks = landmarks_of(frame.grey, frame.depth_m, small_camera(),
                                           kDefaults.place_features, kDefaults.relocalisation);
  ASSERT_GT(landmarks.features.size(), 100U);
  ASSERT_EQ(landmarks.features.size(), landmarks.points_camera.size());
  for (std::size_t i = 0; i < landmarks.features.size(); ++i) {
    const Vector2d& pixel_px = landmarks.features[i].pixel_px;
    EXPECT_LT(pixel_px.x(), 160);
    EXPECT_GT(std::abs(pixel_px.x() - 99.5), 1.0);
    EXPECT_LT((small_camera().project(landmarks.points_camera[i]) - pixel_px).norm(), 1e-9);
  }
}

TEST(Keyframes, LandmarksAreComputedAtTheFirstSearch) {
  RgbdFrame frame = seen_from({});
  frame.grey = noise_image();
  ASSERT_GT(find_corners(frame.grey, kDefaults.place_features).size(), 500U);
  Keyframes keyframes(small_camera(), kDefaults);
  ASSERT_TRUE(keyframes.offer(frame.grey, frame.depth_m, {}, 0));
  EXPECT_FALSE(keyframes[0].landmarks);
  ASSERT_FALSE(keyframes.find(frame.grey).empty());
  ASSERT_TRUE(keyframes[0].landmarks);
  const Landmarks at_once = landmarks_of(frame.grey, frame.depth_m, small_camera(), kDefaults.place_features,
                                         kDefaults.relocalisation);
  const Landmarks& later = *keyframes[0].landmarks;
  ASSERT_EQ(later.features.size(), at_once.features.size());
  for (std::size_t i = 0; i < later.features.size(); ++i) {
    EXPECT_EQ(later.features[i].descriptor, at_once.features[i].descriptor);
    EXPECT_LT((later.points_camera[i] - at_once.points_camera[i]).norm(), 3e-4) << "depth is packed";
  }
}

TEST(Keyframes, WhereCornersAreFewTheLandmarksDecide) {
  // A blurred image has corners on coarse levels only.
  RgbdFrame frame = seen_from({});
  cv::Mat sharp(240, 320, CV_8UC1, frame.grey.data.data());
  GreyImage blurred(320, 240);
  cv::Mat smooth(240, 320, CV_8UC1, blurred.data.data());
  cv::GaussianBlur(sharp, smooth, {}, 2.5);
  ASSERT_LT(find_corners(blurred, kDefaults.place_features).size(), 120U);
  Keyframes keyframes(small_camera(), kDefaults);
  EXPECT_TRUE(keyframes.offer(blurred, frame.depth_m, {}, 0));
  EXPECT_TRUE(keyframes[0].landmarks);
}

TEST(Keyframes, TheNumberOfThreadsDoesNotShow) {
  const int before = cv::getNumThreads();
  const GreyImage query = seen_from({so3_exp({0, 0.1, 0.1}), {-0.1, 0.02, 0}}).grey;
  const auto bytes = [&](int threads) {
    cv::setNumThreads(threads);
    cv::theRNG().state = static_cast<std::uint64_t>(threads);  // nor what others drew
    Keyframes keyframes = one_keyframe();
    const auto found = first_of(keyframes.find(query));
    EXPECT_TRUE(found);
    std::vector<double> numbers;
    for (const PlaceFeature& f : keyframes[0].landmarks->features) {
      numbers.insert(numbers.end(), {f.pixel_px.x(), f.pixel_px.y(), f.scale});
      for (const std::uint64_t word : f.descriptor) {
        numbers.push_back(static_cast<double>(word >> 32U));
        numbers.push_back(static_cast<double>(word & 0xFFFFFFFFU));
      }
    }
    const SE3 pose = found ? found->T_world_camera : SE3{};
    numbers.insert(numbers.end(), {pose.translation.x(), pose.translation.y(), pose.translation.z(),
                                   pose.rotation.x(), pose.rotation.y(), pose.rotation.z()});
    return numbers;
  };
  const std::vector<double> one = bytes(1);
  for (const int threads : {1, 2, 4}) {
    const std::vector<double> other = bytes(threads);
    ASSERT_EQ(one.size(), other.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0) << threads;
  }
  cv::setNumThreads(before);
}

TEST(Keyframes, ImagesOfAnotherSizeAreAMistakeOfTheProgram) {
  Keyframes keyframes(small_camera(), kDefaults);
  EXPECT_THROW(keyframes.offer(GreyImage(64, 48), DepthImage(64, 48), {}, 0), InternalError);
  EXPECT_THROW(static_cast<void>(keyframes.find(GreyImage(64, 48))), InternalError);
}

}  // namespace
}  // namespace fusebench
