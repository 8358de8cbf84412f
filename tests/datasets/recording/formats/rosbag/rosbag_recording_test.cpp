#include "datasets/recording/formats/rosbag/rosbag_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/formats/rosbag/bag_imu.hpp"
#include "datasets/recording/formats/rosbag/lz4_frame.hpp"
#include "datasets/recording/formats/rosbag/ros_images.hpp"
#include "tests/datasets/recording/formats/rosbag/bag_bytes.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace recording;
using namespace formats::rosbag;
using namespace datasets;
using namespace std::string_literals;

namespace {

using testing::any_contains;
using testing::bag_chunk;
using testing::bag_connection;
using testing::bag_message;
using testing::expect_contains;
using testing::ros_header;
using testing::ros_image;
using testing::ros_imu;

std::filesystem::path golden(std::string_view name) {
  return testing::repository_root() / "tests" / "golden" / "rosbag" / name;
}

void expect_golden_images(const Recording& recording) {
  ASSERT_EQ(recording.frames.size(), 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const int shift = static_cast<int>(10 * k);
    EXPECT_EQ(recording.frames[k].timestamp_ns,
              1'600'000'000'000'000'000 + static_cast<std::int64_t>(k) * 33'333'333);
    const auto frame = recording.load_frame(k);
    ASSERT_TRUE(frame) << frame.error().message;
    EXPECT_EQ(frame->color(5, 3),
              (Rgb{static_cast<std::uint8_t>(shift + 5), static_cast<std::uint8_t>(shift + 65),
                   static_cast<std::uint8_t>(shift + 125)}));
  }
}

class Rosbag : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] Error refusal(const std::string& bytes) const {
    const auto opened = open_recording(write("room.bag", "#ROSBAG V2.0\n" + bytes));
    EXPECT_FALSE(opened);
    return opened ? Error{} : opened.error();
  }
};

/// Bags that ROS's own library has written.
TEST_F(Rosbag, AlignedDepthAndBothInertialTopicsOfCompressedChunks) {
  for (const char* name : {"aligned_bz2.bag", "aligned_lz4.bag"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(recognise_format(golden(name)), "rosbag");
    const auto recording = open_recording(golden(name));
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(recording->name + ".bag", name);
    EXPECT_EQ(recording->rig.camera.fx_px, 10);
    EXPECT_EQ(recording->rig.camera.fy_px, 11);
    EXPECT_FALSE(recording->calibration->depth);
    expect_golden_images(*recording);
    const auto frame = recording->load_frame(2);
    EXPECT_EQ(frame->depth_m(3, 1), 1.23F);
    EXPECT_EQ(frame->depth_m(5, 2), 0);
    ASSERT_EQ(recording->imu.size(), 24);
    EXPECT_EQ(recording->imu[3].angular_velocity_radps, Vector3d(0.13, 0, -0.2));
    EXPECT_EQ(recording->imu[3].timestamp_ns, 1'599'999'999'985'000'000);
    // Between samples at -16 and -12 ms, -9.75 and -9.875 m/s^2 in turn.
    EXPECT_NEAR(recording->imu[3].specific_force_mps2.y(), -9.75 - 0.125 * 0.25, 1e-9);
    EXPECT_LT((recording->rig.T_imu_camera.translation - Vector3d(-0.01, 0.01, 0.005)).norm(), 1e-9);
    EXPECT_GT(recording->rig.imu_noise.accelerometer_mps2_sqrthz, 0);
  }
}

TEST_F(Rosbag, DepthOfItsOwnCameraIsRegisteredByStaticTransforms) {
  const auto recording = open_recording(golden("apart_none.bag"));
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_TRUE(recording->calibration->depth);
  EXPECT_EQ(recording->calibration->depth->pinhole.fx_px, 12);
  // The colour camera is 15 mm to the left, along the link's y; its own x points to the right.
  EXPECT_LT((recording->calibration->depth->T_color_depth.translation - Vector3d(0.015, 0, 0)).norm(), 1e-9);
  EXPECT_TRUE(recording->imu.empty());
  expect_golden_images(*recording);
}

TEST_F(Rosbag, ABagThatIsCutOffIsReadUpToThere) {
  const std::string whole = testing::read_bytes(golden("apart_none.bag"));
  const std::size_t index = whole.find("op=\x04");
  ASSERT_NE(index, whole.npos);
  const auto cut = open_recording(write("cut.bag", std::string_view(whole).substr(0, index + 20)));
  ASSERT_TRUE(cut) << cut.error().message;
  EXPECT_EQ(cut->frames.size(), 3);
  EXPECT_TRUE(any_contains(cut->warnings, "ends within a record"));
}

TEST_F(Rosbag, ABagThatIsCutOffBeforeItsImagesSaysSo) {
  const std::string whole = testing::read_bytes(golden("apart_none.bag"));
  const auto cut = open_recording(write("cut.bag", std::string_view(whole).substr(0, 3000)));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::data_corrupt);
  expect_contains(cut.error().message, "ends within a record");
  expect_contains(cut.error().hint, "cut off");
}

TEST_F(Rosbag, DamageIsNamed) {
  EXPECT_EQ(refusal("").code, ErrorCode::data_missing) << "nothing in it";
  expect_contains(refusal("").message, "room.bag: no topic with colour images; there are no images at all");
  write("old.bag", "#ROSBAG V1.2\n");
  expect_contains(open_recording(folder_ / "old.bag").error().message, "does not begin with #ROSBAG V2.0");
  expect_contains(refusal(testing::bag_record(9, {}, "")).message,
                  "byte 13: a record of the unknown operation 9");
  expect_contains(refusal(testing::with_length("op") + testing::with_length("")).message,
                  "byte 13: no record of a bag");
  expect_contains(refusal(bag_message(7, 1, "")).message,
                  "a message of connection 7, which no record before it");
  expect_contains(refusal(bag_chunk("", 0, "zip")).message,
                  "the compression 'zip' (none, bz2 and lz4 are read)");
  for (const char* compression : {"none", "bz2", "lz4"})
    expect_contains(refusal(bag_chunk("damage", 100, compression)).message, "a damaged chunk (compression ");
  expect_contains(refusal(bag_chunk("damage", 6, "none")).message, "a chunk with a damaged record");
  expect_contains(refusal(bag_connection(0, "/a", "sensor_msgs/Image") + bag_message(0, 1, "short")).message,
                  "a message of /a is no sensor_msgs/Image that can be read");
  const std::string image = ros_image(ros_header(1, 0, "c"), 2, 1, "8UC1", 2, "ab");
  expect_contains(refusal(bag_connection(0, "/a", "sensor_msgs/Image") + bag_message(0, 1, image)).message,
                  "no topic with colour images; there is /a (1 images)");
}

TEST_F(Rosbag, ImagesWithoutACameraOrATransformSayWhatIsMissing) {
  const auto images = [](std::string_view depth_topic) {
    const std::string color = ros_image(ros_header(5, 0, "c"), 2, 1, "rgb8", 6, "abcdef");
    const std::string depth = ros_image(ros_header(5, 0, "d"), 2, 1, "16UC1", 4, "\1\1\1\1");
    return bag_connection(0, "/camera/color/image_raw", "sensor_msgs/Image") +
           bag_connection(1, std::string(depth_topic), "sensor_msgs/Image") + bag_message(0, 1, color) +
           bag_message(1, 1, depth);
  };
  const Error no_camera = refusal(images("/camera/depth/image"));
  EXPECT_EQ(no_camera.code, ErrorCode::configuration);
  expect_contains(no_camera.message, "no camera_info beside /camera/color/image_raw");
  ReadOptions options;
  options.camera = calibration::CalibratedCamera{{0, 0, 10, 10, 0.5, 0}, {}, {}};
  const auto given = open_recording(folder_ / "room.bag", {"", options});
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(given->load_frame(0)->depth_m(1, 0), 0.257F);
}

TEST_F(Rosbag, DistortionOfTheUsedCameraMustBeSupported) {
  const auto bag = [](std::string_view model, double k1) {
    const std::string header = ros_header(5, 0, "c");
    const auto info = [&](std::string_view name, double coefficient) {
      return testing::ros_camera_info(header, 2, 1, name, {coefficient, 0, 0, 0, 0},
                                      {10, 0, 0.5, 0, 11, 0, 0, 0, 1});
    };
    return bag_connection(0, "/color/image_raw", "sensor_msgs/Image") +
           bag_connection(1, "/aligned_depth/image", "sensor_msgs/Image") +
           bag_connection(2, "/color/camera_info", "sensor_msgs/CameraInfo") +
           bag_connection(3, "/fisheye1/camera_info", "sensor_msgs/CameraInfo") +
           bag_message(0, 1, ros_image(header, 2, 1, "rgb8", 6, "abcdef")) +
           bag_message(1, 1, ros_image(header, 2, 1, "16UC1", 4, "\1\1\1\1")) +
           bag_message(2, 1, info(model, k1)) + bag_message(3, 1, info("equidistant", 0.5));
  };
  const auto open = [&](const std::string& bytes) {
    return open_recording(write("room.bag", "#ROSBAG V2.0\n" + bytes));
  };
  const auto radtan = open(bag("radtan", 0.25));
  ASSERT_TRUE(radtan) << "the camera that is not used does not matter: " << radtan.error().message;
  EXPECT_EQ(radtan->calibration->color.distortion.k1, 0.25);
  EXPECT_TRUE(open(bag("inverse_brown_conrady", 0)));
  const Error refused = refusal(bag("equidistant", 0.25));
  EXPECT_EQ(refused.code, ErrorCode::data_corrupt);
  expect_contains(refused.message,
                  "room.bag: /color/camera_info: distortion model equidistant is not supported");
}

TEST_F(Rosbag, BagsOfRos2AreRefusedWithWhatConvertsThem) {
  for (const char* name : {"room_0.db3", "room.mcap"}) {
    const auto refused = open_recording(write(name, "any"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::configuration);
    expect_contains(refused.error().message, "bags of ROS 2 (.db3, .mcap) are not read");
    expect_contains(refused.error().hint, "rosbags-convert --src");
  }
  EXPECT_EQ(open_recording(folder_).error().code, ErrorCode::configuration) << "the folder of such a bag";
}

/// Drivers that unite the topics "by copy" send the old value of the one with the new value of the other.
TEST_F(Rosbag, CopiedHalvesOfInertialMessagesAreLeftOut) {
  BagTopics topics;
  ImuTopic& imu = topics.imus["/camera/imu"];
  imu.frame_id = "imu";
  for (int i = 0; i < 40; ++i) {
    const auto message = imu_message(ros_imu(ros_header(10, static_cast<std::uint32_t>(i * 5'000'000), "imu"),
                                             {0.1 * (i / 2), 0, 0}, {0, 0, 9 + 0.1 * ((i + 1) / 2)}));
    ASSERT_TRUE(message);
    imu.samples.push_back(*message);
  }
  Recording recording;
  EXPECT_EQ(take_imu(topics, "room.bag", recording).value(), "imu");
  ASSERT_GE(recording.imu.size(), 18);
  for (std::size_t i = 1; i < recording.imu.size(); ++i) {
    EXPECT_EQ(recording.imu[i].timestamp_ns - recording.imu[i - 1].timestamp_ns, 10'000'000);
    EXPECT_NEAR(recording.imu[i].angular_velocity_radps.x() - recording.imu[i - 1].angular_velocity_radps.x(),
                0.1, 1e-9);
    EXPECT_NEAR(recording.imu[i].specific_force_mps2.z() - recording.imu[i - 1].specific_force_mps2.z(), 0.1,
                1e-9);
  }
}

/// As realsense-ros with unite_imu_method:=copy sends them: a message for each sample of either sensor, with
/// its stamp and the newest value of the other.
TEST_F(Rosbag, CopiesOfASensorThatLagsAreNoSamples) {
  struct Arrival {
    std::int64_t arrival_us;
    std::int64_t stamp_us;
    bool is_gyroscope;
  };
  std::vector<Arrival> arrivals;
  for (std::int64_t i = 0; i < 200; ++i) arrivals.push_back({5000 * i, 5000 * i, true});
  for (std::int64_t i = 0; i < 250; ++i) arrivals.push_back({4000 * i + 13'000, 4000 * i, false});
  std::ranges::stable_sort(arrivals, {}, &Arrival::arrival_us);
  BagTopics topics;
  ImuTopic& imu = topics.imus["/camera/imu"];
  double rate = 0;
  double force = 0;
  for (const Arrival& a : arrivals) {
    (a.is_gyroscope ? rate : force) = 1 + 1e-6 * static_cast<double>(a.stamp_us);
    const auto message = imu_message(ros_imu(
        ros_header(10, static_cast<std::uint32_t>(1000 * a.stamp_us), "imu"), {rate, 0, 0}, {0, 0, force}));
    ASSERT_TRUE(message);
    imu.samples.push_back(*message);
  }
  Recording recording;
  ASSERT_TRUE(take_imu(topics, "room.bag", recording));
  EXPECT_TRUE(
      any_contains(recording.notes, "250 accelerometer samples are interpolated to 200 gyroscope times"));
  ASSERT_EQ(recording.imu.size(), 200);
  for (std::size_t i = 0; i < 200; ++i) {
    const double time_s = 0.005 * static_cast<double>(i);
    EXPECT_NEAR(1e-9 * static_cast<double>(recording.imu[i].timestamp_ns) - 10, time_s, 1e-9);
    EXPECT_NEAR(recording.imu[i].angular_velocity_radps.x(), 1 + time_s, 1e-9);
    EXPECT_NEAR(recording.imu[i].specific_force_mps2.z(), 1 + time_s, 1e-9);
  }
}

TEST_F(Rosbag, UnitedMessagesOutOfOrderAreSorted) {
  BagTopics topics;
  for (const std::uint32_t k : {0U, 2U, 1U, 3U, 3U})
    topics.imus["/imu"].samples.push_back(
        *imu_message(ros_imu(ros_header(10, k * 5'000'000, "imu"), {0.1 * k + 1, 0, 0}, {0, 0, 9.0 + k})));
  Recording recording;
  ASSERT_TRUE(take_imu(topics, "room.bag", recording));
  ASSERT_EQ(recording.imu.size(), 4);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(recording.imu[k].specific_force_mps2.z(), 9.0 + static_cast<double>(k));
}

TEST_F(Rosbag, EncodingsOfImages) {
  const auto color = [](std::string_view encoding, std::uint32_t step, std::string_view data) {
    const std::string bytes = ros_image(ros_header(1, 0, "c"), 2, 1, encoding, step, data);
    return color_of(*image_message(bytes), "an image");
  };
  EXPECT_EQ((*color("rgb8", 6, "abcdef"))(1, 0), (Rgb{'d', 'e', 'f'}));
  EXPECT_EQ((*color("bgr8", 8, "abcdef__"))(1, 0), (Rgb{'f', 'e', 'd'})) << "rows may be longer";
  EXPECT_EQ((*color("bgra8", 8, "abc_def_"))(1, 0), (Rgb{'f', 'e', 'd'}));
  EXPECT_EQ((*color("mono8", 2, "ab"))(1, 0), (Rgb{'b', 'b', 'b'}));
  expect_contains(color("rgb8", 6, "abcde").error().message,
                  "an image: 5 bytes in rows of 6 are not 2x1 pixels");
  expect_contains(color("yuv422", 6, "abcdef").error().message, "encoding 'yuv422' (read are rgb8, ");
  const auto depth = [](std::string_view encoding, std::string_view data) {
    const std::string bytes =
        ros_image(ros_header(1, 0, "c"), 2, 1, encoding, static_cast<std::uint32_t>(data.size()), data);
    return depth_of(*image_message(bytes), 1000, "an image");
  };
  EXPECT_EQ((*depth("16UC1", "\xe8\x03\xff\xff"))(0, 0), 1);
  EXPECT_EQ((*depth("mono16", "\xe8\x03\xff\xff"))(1, 0), 0) << "65535 is no measurement";
  EXPECT_EQ((*depth("32FC1", "\x00\x00\xc0\x3f\x00\x00\xc0\x7f"s))(0, 0), 1.5F);
  EXPECT_EQ((*depth("32FC1", "\x00\x00\xc0\x3f\x00\x00\xc0\x7f"s))(1, 0), 0) << "NaN";
}

TEST_F(Rosbag, GreyImagesAreTakenWhereThereIsNoColour) {
  BagTopics topics;
  topics.images["/camera/depth/image"].kind = ImageKind::depth;
  ImageTopic grey;
  grey.kind = ImageKind::color;
  grey.is_grey = true;
  for (const char* name : {"/camera/infra1/image", "/camera/confidence/image", "/camera/rgb/image_mono"})
    topics.images[name] = grey;
  EXPECT_EQ(choose_topics(topics, "room.bag").value().color, "/camera/rgb/image_mono");
  topics.images["/usb_cam/image"].kind = ImageKind::color;
  EXPECT_EQ(choose_topics(topics, "room.bag").value().color, "/usb_cam/image");
}

TEST_F(Rosbag, CompressedTopicsHoldImageFiles) {
  const auto jpeg = images::encode_jpeg(ColorImage(16, 8, Rgb{200, 100, 50}), 95);
  ASSERT_TRUE(jpeg);
  const std::string color = ros_header(5, 0, "c") + testing::with_length("rgb8; jpeg compressed bgr8") +
                            testing::with_length({reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
  ASSERT_TRUE(images::write_png(folder_ / "depth.png", Image<std::uint16_t>(16, 8, 1250)));
  const std::string depth =
      ros_header(5, 0, "c") + testing::with_length("16UC1; compressedDepth png") +
      testing::with_length(std::string(12, '\0') + testing::read_bytes(folder_ / "depth.png"));
  write("c.bag", "#ROSBAG V2.0\n" +
                     bag_connection(0, "/camera/color/image_raw/compressed", "sensor_msgs/CompressedImage") +
                     bag_connection(1, "/camera/aligned_depth_to_color/image_raw/compressedDepth",
                                    "sensor_msgs/CompressedImage") +
                     bag_message(0, 1, color) + bag_message(1, 1, depth));
  ReadOptions options;
  options.camera = calibration::CalibratedCamera{{0, 0, 10, 10, 7.5, 3.5}, {}, {}};
  const auto recording = open_recording(folder_ / "c.bag", {"", options});
  ASSERT_TRUE(recording) << recording.error().message;
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_NEAR(frame->color(7, 3)[0], 200, 6);
  EXPECT_EQ(frame->depth_m(7, 3), 1.25F);
}

TEST_F(Rosbag, Lz4) {
  const std::string magic = "\x04\x22\x4d\x18\x60\x40\x82"s;
  // Literals "abcd", then a match of 8 at offset 4, which overlaps itself, then literals "xyz12".
  const std::string block =
      "\x44"
      "abcd"
      "\x04\x00"
      "\x50"
      "xyz12"s;
  const std::string frame = magic + testing::with_length(block) + "\0\0\0\0"s;
  EXPECT_EQ(lz4_content(frame, 17), "abcdabcdabcdxyz12");
  EXPECT_FALSE(lz4_content(frame, 16)) << "another size";
  for (std::size_t cut = 0; cut < frame.size(); ++cut)
    EXPECT_FALSE(lz4_content(frame.substr(0, cut), 17)) << cut;
  const std::string stored = magic + "\x03\x00\x00\x80"s + "abc" + "\0\0\0\0"s;
  EXPECT_EQ(lz4_content(stored, 3), "abc");
  EXPECT_FALSE(lz4_content(magic +
                               testing::with_length("\x04"
                                                    "\x09\x00"s) +
                               "\0\0\0\0"s,
                           8))
      << "before the beginning";
}

}  // namespace
}  // namespace fusebench
