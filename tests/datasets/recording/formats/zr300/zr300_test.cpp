#include "datasets/recording/formats/zr300/zr300.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "datasets/calibration/recording_catalogue.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/formats/zr300/zr300_lists.hpp"
#include "datasets/recording/reading/inertial_samples.hpp"
#include "tests/datasets/recording/formats/zr300/zr300_folder.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace calibration;
using namespace recording;
using namespace reading;
using namespace formats::zr300;
using namespace datasets;

namespace {

using testing::any_contains;
using testing::expect_contains;
using testing::kZr300Frames;
using testing::zr300_frame_us;
using testing::Zr300Folder;

/// Message and hint of the expected error.
std::string refusal(const Zr300Folder& folder, ErrorCode code, const ReadOptions& options = {}) {
  const auto recording = open_recording(folder.path(), {"", options});
  if (recording) return "was not refused";
  EXPECT_EQ(recording.error().code, code) << recording.error().message;
  return recording.error().message + " | " + recording.error().hint;
}

/// A row of TIMESTAMP.txt for each frame, by its number.
std::string rows(const std::function<std::string(int)>& row) {
  std::string text = "#timestamp(us) colorname depthname\n";
  for (int i = 0; i < kZr300Frames; ++i) text += row(i) + "\n";
  return text;
}

TEST(Zr300, OpensAFolder) {
  const Zr300Folder folder;
  const auto recording = open_recording(folder.path());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "zr300");
  ASSERT_EQ(recording->frames.size(), 4U);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 1000 * zr300_frame_us(1));
  EXPECT_EQ(recording->frames[1].depth_timestamp_ns, 1000 * zr300_frame_us(1));
  EXPECT_EQ(recording->frames[2].color_file, folder.path() / "color" / "822067.png");
  EXPECT_EQ(recording->imu_source, ImuSource::recorded);
  ASSERT_EQ(recording->imu.size(), 140U) << "the half second before the images is kept";
  EXPECT_EQ(recording->imu[3].timestamp_ns, 265'000'000);
  EXPECT_EQ(recording->imu[3].angular_velocity_radps, Vector3d(3, 0.25, -0.5));
  EXPECT_EQ(recording->imu[3].specific_force_mps2, Vector3d(0.265, 9.75, 0));
  EXPECT_EQ(recording->rig.T_imu_camera.translation, Vector3d(0.1, 0, 0));
  EXPECT_EQ(recording->rig.imu_noise.gyroscope_radps_sqrthz, 1e-3);
  EXPECT_EQ(recording->rig.camera.fy_px, 21);
  EXPECT_TRUE(recording->ground_truth.empty());
  EXPECT_TRUE(recording->warnings.empty());
  EXPECT_TRUE(
      any_contains(recording->notes, "calibration: calibration.toml in the recording's folder (a test)"));
  EXPECT_TRUE(
      any_contains(recording->notes, "TIMESTAMP.txt: times are in microseconds (a row every 33.3 ms)"));
  EXPECT_TRUE(any_contains(recording->notes, "IMU.txt: times are in microseconds (a row every 5 ms)"));
  const auto frame = recording->load_frame(2);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_NEAR(frame->depth_m(5, 5), 1.002, 1e-6);
  EXPECT_EQ(frame->color(5, 5), (Rgb{10, 20, 30}));
}

TEST(Zr300, FilteredDepthIsAChoice) {
  const Zr300Folder folder;
  ReadOptions options;
  options.filtered_depth = true;
  const auto filtered = open_zr300(folder.path(), options);
  ASSERT_TRUE(filtered) << filtered.error().message;
  EXPECT_NEAR(filtered->load_frame(2)->depth_m(5, 5), 2.002, 1e-6);
  EXPECT_NE(filtered->fingerprint, open_zr300(folder.path(), {})->fingerprint);
  folder.remove("filtered/755517.png");
  const std::string message = refusal(folder, ErrorCode::data_missing, options);
  expect_contains(message, "TIMESTAMP.txt:2: image ");
  expect_contains(message, "filtered/755517.png does not exist");
}

TEST(Zr300, UnitsAreFoundForImagesAndImuApart) {
  struct Case {
    double units_per_us;
    std::string_view name;
  };
  const Zr300Folder folder;
  const auto original = open_zr300(folder.path(), {});
  ASSERT_TRUE(original);
  for (const Case& image : {Case{1e-6, "seconds"}, {1e-3, "milliseconds"}, {1e3, "nanoseconds"}}) {
    folder.write("TIMESTAMP.txt", rows([&](int i) {
                   const double stamp = static_cast<double>(zr300_frame_us(i)) * image.units_per_us;
                   return fmt::format("{},{}.png,{}.png", stamp, zr300_frame_us(i), zr300_frame_us(i));
                 }));
    for (const Case& imu : {Case{1e-6, "seconds"}, {1e-3, "milliseconds"}, {1e3, "nanoseconds"}}) {
      folder.write("IMU.txt", Zr300Folder::imu_rows(imu.units_per_us, 250'000, 140));
      const auto recording = open_zr300(folder.path(), {});
      ASSERT_TRUE(recording) << recording.error().message;
      EXPECT_TRUE(any_contains(recording->notes, fmt::format("TIMESTAMP.txt: times are in {}", image.name)));
      EXPECT_TRUE(any_contains(recording->notes, fmt::format("IMU.txt: times are in {}", imu.name)));
      EXPECT_EQ(recording->fingerprint, original->fingerprint) << "the same values";
    }
  }
}

TEST(Zr300, OtherSpellingsOfTheSameList) {
  const Zr300Folder folder;
  const std::string original = open_zr300(folder.path(), {})->fingerprint;
  const auto fingerprint = [&](const std::function<std::string(int)>& row) {
    folder.write("TIMESTAMP.txt", rows(row) + "\n");
    const auto recording = open_zr300(folder.path(), {});
    return recording ? recording->fingerprint : recording.error().message;
  };
  EXPECT_EQ(
      fingerprint([](int i) { return fmt::format("{0},color/{0}.png,depth/{0}.png", zr300_frame_us(i)); }),
      original);
  EXPECT_EQ(fingerprint([](int i) { return fmt::format("{0} {0}.png {0}.png\r", zr300_frame_us(i)); }),
            original);
  folder.write("IMU.txt", "\xEF\xBB\xBF" + Zr300Folder::imu_rows(1, 250'000, 140) + "\r\n\r\n");
  EXPECT_EQ(open_zr300(folder.path(), {})->fingerprint, original);
}

TEST(Zr300, DepthTakesItsTimeFromItsName) {
  const Zr300Folder folder;
  for (int i = 0; i < kZr300Frames; ++i)
    folder.write_images(fmt::format("{}.png", zr300_frame_us(i) + 4000), i);
  folder.write("TIMESTAMP.txt", rows([](int i) {
                 return fmt::format("{0},{0}.png,{1}.png", zr300_frame_us(i), zr300_frame_us(i) + 4000);
               }));
  const auto recording = open_zr300(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 4U);
  EXPECT_EQ(recording->frames[3].depth_timestamp_ns - recording->frames[3].timestamp_ns, 4'000'000);
  EXPECT_TRUE(any_contains(recording->notes, "4 of 4 depth images have a time of their own"));
}

TEST(Zr300, NamesThatAreNotTimesSayNothing) {
  const Zr300Folder folder;
  for (int i = 0; i < kZr300Frames; ++i) folder.write_images(fmt::format("{}.png", i), i);
  folder.write("TIMESTAMP.txt",
               rows([](int i) { return fmt::format("{0},{1}.png,{1}.png", zr300_frame_us(i), i); }));
  const auto recording = open_zr300(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->frames[3].depth_timestamp_ns, recording->frames[3].timestamp_ns);
}

TEST(Zr300, ADepthImageIsUsedOnce) {
  const Zr300Folder folder;
  folder.write("TIMESTAMP.txt", rows([](int i) {
                 return fmt::format("{},{}.png,{}.png", zr300_frame_us(i), zr300_frame_us(i),
                                    zr300_frame_us(i == 2 ? 1 : i));
               }));
  const auto recording = open_zr300(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->frames.size(), 3U);
  EXPECT_TRUE(any_contains(recording->warnings, "1 of 4 colour and 0 of 3 depth images have no partner"));
}

TEST(Zr300, RefusesBadLists) {
  const auto after_writing = [](const std::string& name, std::string_view content,
                                ErrorCode code = ErrorCode::data_corrupt) {
    const Zr300Folder folder;
    folder.write(name, content);
    return refusal(folder, code);
  };
  const std::string frame = fmt::format("{0}.png,{0}.png\n", zr300_frame_us(0));
  expect_contains(after_writing("TIMESTAMP.txt", "#\n"),
                  "TIMESTAMP.txt: has 0 rows, too few to tell the unit");
  expect_contains(after_writing("TIMESTAMP.txt", "#\n0.0," + frame + "0.1\n"),
                  "TIMESTAMP.txt:3: expected 3 columns: timestamp color depth, got 1");
  expect_contains(after_writing("TIMESTAMP.txt", "1," + frame + "2," + frame + "3," + frame),
                  "rows are 1 apart in time (median), which is 5 to 250 ms in none of the units");
  expect_contains(
      after_writing("TIMESTAMP.txt", "0.1," + frame + "0.2," + frame + "0.15," + frame + "0.3," + frame),
      "TIMESTAMP.txt:3: time runs backwards by 0.05 s");
  expect_contains(
      after_writing("TIMESTAMP.txt", "0.1," + frame + "0.2," + frame + "0.3," + frame + "0.3," + frame),
      "TIMESTAMP.txt:4: timestamp 0.3 is the same as that of line 3");
  expect_contains(
      after_writing("TIMESTAMP.txt", "0.1," + frame + "0.2,a.png,b.png\n", ErrorCode::data_missing),
      "TIMESTAMP.txt:2: image ");
  expect_contains(after_writing("IMU.txt", "1,2,3\n"),
                  "IMU.txt:1: expected 4 or 7 columns: timestamp gx gy gz ax ay az, got 3");
  expect_contains(after_writing("IMU.txt", "0.1,2,3,4,5,6,7\n0.105,2,nan,4\n"),
                  "IMU.txt:2: gy: expected a finite number, got 'nan'");
  expect_contains(
      after_writing("IMU.txt", "0.100,1,1,1,1,1,1\n0.105,1,1,1,1,1,1\n0.101,1,1,1,1,1,1\n0.106,1,1,1\n"),
      "IMU.txt:3: time runs backwards");
  expect_contains(after_writing("IMU.txt", "0.1,1,1,1\n0.105,1,1,1\n"),
                  "IMU.txt: no gyroscope sample lies between two accelerometer samples");
  expect_contains(after_writing("IMU.txt", "1,1,1,1,1,1,1\n1.3,1,1,1,1,1,1\n"),
                  "which is 0.5 to 50 ms in none");
}

TEST(Zr300, ScalesOfTheImuAreTakenOutAndPartOfTheFingerprint) {
  const Zr300Folder folder;
  const auto raw = open_zr300(folder.path(), {});
  calibration::RigCalibration calibration = Zr300Folder::calibration();
  calibration.imu->gyroscope_scale = {1.5, 0.5, 1};
  calibration.imu->accelerometer_scale = {1, 0.75, 2};
  folder.write("calibration.toml", calibration::to_toml(calibration));
  const auto scaled = open_zr300(folder.path(), {});
  ASSERT_TRUE(raw && scaled);
  EXPECT_EQ(scaled->imu[3].angular_velocity_radps, Vector3d(2, 0.5, -0.5));
  EXPECT_EQ(scaled->imu[3].specific_force_mps2, Vector3d(0.265, 13, 0));
  EXPECT_EQ(scaled->imu[3].timestamp_ns, raw->imu[3].timestamp_ns);
  EXPECT_NE(scaled->fingerprint, raw->fingerprint);
}

TEST(Zr300, RefusesAnImuOfAnotherTime) {
  const Zr300Folder folder;
  folder.write("IMU.txt", Zr300Folder::imu_rows(1, 5'000'000, 20));
  const std::string message = refusal(folder, ErrorCode::data_corrupt);
  expect_contains(message, "inertial samples (times 5.000000000 to 5.095000000)");
  expect_contains(message, "do not overlap the images (times 0.755517000 to 0.855342000)");
}

TEST(Zr300, AnImuThatEndsEarlyIsAWarning) {
  const Zr300Folder folder;
  folder.write("IMU.txt", Zr300Folder::imu_rows(1, 250'000, 105));  // until 0.770 s
  const auto recording = open_zr300(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(any_contains(recording->warnings, "3 of 4 frames are before the first or after the last"));
}

TEST(Zr300, ShortRowsKeepTheirGyroscope) {
  const Zr300Folder folder;
  folder.write("IMU.txt",
               "#timestamp(us) gx gy gz ax ay az\n700000,9,0,0\n750000,1,0,0,1,10,-1\n755000,2,0,0\n"
               "760000,3,0,0,3,20,-3\n762000,4,0,0\n762000,4,0,0\n765000,5,0,0,4,30,-4\n770000,6,0,0\n");
  const auto recording = open_zr300(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->imu.size(), 5U);
  EXPECT_EQ(recording->imu[1].timestamp_ns, 755'000'000);
  EXPECT_EQ(recording->imu[1].angular_velocity_radps, Vector3d(2, 0, 0));
  EXPECT_EQ(recording->imu[1].specific_force_mps2, Vector3d(2, 15, -2));
  EXPECT_LT((recording->imu[3].specific_force_mps2 - Vector3d(3.4, 24, -3.4)).norm(), 1e-12);
  EXPECT_EQ(recording->imu[4].specific_force_mps2, Vector3d(4, 30, -4));
  EXPECT_TRUE(
      any_contains(recording->notes, "IMU.txt: 4 of 7 rows have no accelerometer, which is interpolated"));
  EXPECT_TRUE(any_contains(recording->warnings, "1 rows repeat the stamp of the row before"));
  EXPECT_TRUE(
      any_contains(recording->warnings, "2 of 7 gyroscope samples have no accelerometer around them"));
}

TEST(InterpolateAccelerometer, IsExactForALineAndDropsWhatIsOutside) {
  std::vector<GyroscopeSample> gyroscope;
  std::vector<AccelerometerSample> accelerometer;
  const auto force = [](std::int64_t t_ns) { return Vector3d(1e-9 * static_cast<double>(t_ns), 9.81, 0); };
  for (std::int64_t t_ns = 0; t_ns <= 1'000'000'000; t_ns += 5'000'000)
    gyroscope.push_back({t_ns, Vector3d(static_cast<double>(t_ns), 0, 0)});
  for (std::int64_t t_ns = 101'000'000; t_ns <= 900'000'000; t_ns += 4'000'000) {
    if (t_ns > 500'000'000 && t_ns < 600'000'000) continue;  // a pause
    accelerometer.push_back({t_ns, force(t_ns)});
  }
  const auto samples = interpolate_accelerometer(gyroscope, accelerometer);
  EXPECT_EQ(samples.front().timestamp_ns, 105'000'000);
  EXPECT_EQ(samples.back().timestamp_ns, 895'000'000);
  for (const ImuSample& sample : samples) {
    EXPECT_EQ(sample.angular_velocity_radps.x(), static_cast<double>(sample.timestamp_ns));
    EXPECT_LT((sample.specific_force_mps2 - force(sample.timestamp_ns)).norm(), 1e-12);
    EXPECT_FALSE(sample.timestamp_ns > 497'000'000 && sample.timestamp_ns < 601'000'000);
  }
  EXPECT_EQ(samples.size(), 159U - 21U) << "21 in the pause, from 497 to 601 ms";
}

/// The same frames as the recorder lists them: nanoseconds under "(ms)", not associated, two inertial rates.
class RawFolder : public Zr300Folder {
 public:
  RawFolder() {
    for (const char* list : {"TIMESTAMP.txt", "IMU.txt"}) remove(list);
    std::string color = "#timestamp(ms) filename\n";
    std::string depth = color;
    for (int i = 0; i < kZr300Frames; ++i) {
      const std::int64_t color_ns = 1000 * zr300_frame_us(i);
      const std::int64_t depth_ns = color_ns + 3'000'000;
      color += fmt::format("{0}.00 {0}.png\n", color_ns);
      if (i != 1) depth += fmt::format("{0}.00 {0}.png\n", depth_ns);
      write_images(fmt::format("{}.png", color_ns), i);
      write_images(fmt::format("{}.png", depth_ns), i);
    }
    write("COLOR.txt", color);
    write("DEPTH.txt", depth);
    std::string gyro = "#timestamp(ms) rx(rad s^-1) ry(rad s^-1) rz(rad s^-1)";
    std::string accel = "#timestamp(ms) ax(m s^-2) ay(m s^-2) az(m s^-2)\n";
    for (std::int64_t t_ns = 500'000'000; t_ns <= 1'000'000'000; t_ns += 5'000'000) {
      gyro += fmt::format("\n{}.00 0.1 0.2 0.3", t_ns);
      if (t_ns % 2'000'000 == 0) gyro += " 1.0 2.0 3.0";  // the recorder appends to some rows
    }
    for (std::int64_t t_ns = 501'000'000; t_ns <= 999'000'000; t_ns += 4'000'000)
      accel += fmt::format("{}.00 {} 9.8 0\n", t_ns, 1e-9 * static_cast<double>(t_ns));
    write("GYRO.txt", gyro);
    write("ACCEL.txt", accel);
  }
};

TEST(Zr300Raw, OpensTheRecordersLists) {
  const RawFolder folder;
  const auto recording = open_recording(folder.path());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "zr300_raw");
  ASSERT_EQ(recording->frames.size(), 3U);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 1000 * zr300_frame_us(2));
  EXPECT_EQ(recording->frames[1].depth_timestamp_ns, 1000 * zr300_frame_us(2) + 3'000'000);
  EXPECT_TRUE(any_contains(recording->warnings, "1 of 4 colour and 0 of 3 depth images"));
  EXPECT_TRUE(any_contains(recording->notes, "COLOR.txt: times are in nanoseconds"));
  ASSERT_EQ(recording->imu.size(), 99U);
  for (const ImuSample& sample : recording->imu) {
    EXPECT_NEAR(sample.specific_force_mps2.x(), 1e-9 * static_cast<double>(sample.timestamp_ns), 1e-9);
    EXPECT_EQ(sample.angular_velocity_radps, Vector3d(0.1, 0.2, 0.3));
  }
  EXPECT_TRUE(
      any_contains(recording->warnings, "2 of 101 gyroscope samples have no accelerometer around them"));
  EXPECT_NEAR(recording->load_frame(1)->depth_m(5, 5), 1.002, 1e-6);
}

TEST(Zr300Raw, MissingPartsAreNamed) {
  const RawFolder folder;
  folder.remove("ACCEL.txt");
  expect_contains(refusal(folder, ErrorCode::data_missing), "ACCEL.txt: no such file");
  folder.remove("GYRO.txt");
  const auto recording = open_recording(folder.path());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->imu_source, ImuSource::none);
  folder.remove(fmt::format("depth/{}.png", 1000 * zr300_frame_us(2) + 3'000'000));
  expect_contains(refusal(folder, ErrorCode::data_missing), "DEPTH.txt:3: image ");
}

TEST(Zr300, FilesBesideTheImages) {
  const Zr300Folder folder;
  folder.write("groundtruth.txt",
               "0.7 1 2 3 0 0 0 1\n0.75 1 2 3 0 0 0 1\n0.8 1 2 3 0 0 0 1\n0.9 1 2 3 0 0 0 1\n");
  folder.write("imu.csv", "#t\n740000000,7,7,7,7,7,7\n900000000,7,7,7,7,7,7\n");
  const auto with_own = open_zr300(folder.path(), {});
  ASSERT_TRUE(with_own) << with_own.error().message;
  EXPECT_EQ(with_own->ground_truth.size(), 4U);
  EXPECT_EQ(with_own->imu.size(), 140U) << "IMU.txt has precedence";
  folder.remove("IMU.txt");
  const auto with_csv = open_zr300(folder.path(), {});
  ASSERT_TRUE(with_csv) << with_csv.error().message;
  EXPECT_EQ(with_csv->imu.size(), 2U);
}

TEST(Zr300, WithoutACalibratedImuThereIsNone) {
  const Zr300Folder folder;
  RigCalibration calibration = Zr300Folder::calibration();
  calibration.imu.reset();
  folder.write("calibration.toml", to_toml(calibration));
  const auto recording = open_zr300(folder.path(), {});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->imu_source, ImuSource::none);
  EXPECT_TRUE(any_contains(recording->warnings, "nothing says where the IMU sits"));
}

/// FMDataset itself, where it is there.
TEST(Zr300, OpensFmDataset) {
  const char* const data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "FUSEBENCH_DATA is not set";
  const CatalogueEntry* const entry = find_catalogue_entry("dorm1_slow");
  ASSERT_NE(entry, nullptr);
  const auto folder = catalogue_folder(*entry, data);
  if (!folder) GTEST_SKIP() << data << " has no dorm1_slow of FMDataset";
  const auto recording = open_recording(*folder);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(static_cast<std::int64_t>(recording->frames.size()), entry->frames);
  EXPECT_TRUE(recording->load_frame(0));
}

}  // namespace
}  // namespace fusebench
