#include "datasets/calibration/recording_catalogue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "datasets/calibration/camera_presets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace calibration;

namespace {

constexpr std::string_view kSmall =
    "kind = \"recording\"\nname = \"x\"\ntitle = \"t\"\nfamily = \"tum\"\nformat = \"tum\"\nfolders = "
    "[\"f\"]\n"
    "page = \"https://p\"\nlicence = \"l\"\ndownload = [\"https://p/x.tgz\"]\n";

TEST(RecordingCatalogue, EachFileReads) {
  ASSERT_FALSE(catalogue_files().empty());
  std::size_t recordings = 0;
  for (const CatalogueFile& file : catalogue_files()) {
    const bool is_calibration = file.text.find("kind = \"calibration\"") != std::string_view::npos;
    const std::string stem = std::filesystem::path(file.name).stem().string();
    if (is_calibration) {
      const auto calibration = catalogue_calibration(stem);
      EXPECT_TRUE(calibration.has_value()) << calibration.error().message;
      continue;
    }
    ++recordings;
    const auto entry = parse_catalogue_entry(file.text, std::string(file.name));
    ASSERT_TRUE(entry.has_value()) << entry.error().message;
    EXPECT_EQ(entry->name, stem) << "the name is that of the file";
  }
  EXPECT_EQ(recording_catalogue().size(), recordings);
}

TEST(RecordingCatalogue, NamesFoldersAndAddressesAreOfOneRecordingEach) {
  std::set<std::string> seen;
  for (const CatalogueEntry& entry : recording_catalogue()) {
    EXPECT_TRUE(seen.insert(entry.name).second) << entry.name;
    for (const std::string& address : entry.downloads) {
      EXPECT_TRUE(address.starts_with("https://")) << entry.name << ": " << address;
      EXPECT_TRUE(seen.insert(address).second) << address;
    }
    for (const std::string& folder : entry.folders) {
      if (folder != entry.name) {
        EXPECT_TRUE(seen.insert(folder).second) << folder;
      }
      EXPECT_TRUE(std::filesystem::path(folder).is_relative()) << folder;
      EXPECT_EQ(folder.find(".."), std::string::npos) << folder;
      EXPECT_EQ(catalogue_entry_of_folder(std::filesystem::path("/some/data") / folder), &entry) << folder;
    }
  }
}

TEST(RecordingCatalogue, CamerasAndCalibrationsExist) {
  for (const CatalogueEntry& entry : recording_catalogue()) {
    if (!entry.camera.empty()) {
      EXPECT_TRUE(parse_camera(entry.camera).has_value()) << entry.name;
      const auto by_folder = camera_by_folder_name(entry.folders.front());
      ASSERT_TRUE(by_folder.has_value()) << entry.name;
      EXPECT_EQ(by_folder->pinhole.fx_px, parse_camera(entry.camera)->pinhole.fx_px) << entry.name;
    }
    if (!entry.calibration.empty()) {
      EXPECT_TRUE(catalogue_calibration(entry.calibration).has_value()) << entry.name;
    }
  }
}

TEST(RecordingCatalogue, HoldsWhatThePaperAndItsPeersReport) {
  for (const char* name :
       {"fr1_desk",       "fr1_xyz",        "fr1_rpy",       "fr2_xyz",     "fr2_desk",    "fr3_office",
        "icl_lr_kt0",     "icl_lr_kt1",     "icl_lr_kt2",    "icl_lr_kt3",  "icl_lr_kt0n", "icl_lr_kt1n",
        "icl_lr_kt2n",    "icl_lr_kt3n",    "dorm1_slow",    "dorm1_fast1", "dorm2_fast",  "hotel_fast1",
        "camera_shake_1", "camera_shake_2", "camera_shake_3"}) {
    EXPECT_NE(find_catalogue_entry(name), nullptr) << name;
  }
  EXPECT_EQ(find_catalogue_entry("fr9_desk"), nullptr);
  EXPECT_EQ(find_catalogue_entry("zr300_fmdataset"), nullptr) << "a calibration is no recording";
  EXPECT_EQ(find_catalogue_entry("fr1_desk")->color_images, 613);
  EXPECT_EQ(find_catalogue_entry("dorm1_slow")->frames, 1519);
}

TEST(RecordingCatalogue, AFolderIsKnownByItsLastNames) {
  const auto name_of = [](const char* folder) {
    const CatalogueEntry* entry = catalogue_entry_of_folder(folder);
    return entry == nullptr ? std::string() : entry->name;
  };
  EXPECT_EQ(name_of("/data/rgbd_dataset_freiburg1_desk"), "fr1_desk");
  EXPECT_EQ(name_of("rgbd_dataset_freiburg1_desk/"), "fr1_desk");
  EXPECT_EQ(name_of("/data/dorm1/./dorm1_slow"), "dorm1_slow");
  // Part of a recording, or another one with a longer name, is not that recording.
  EXPECT_EQ(name_of("/data/rgbd_dataset_freiburg1_rpy_first240"), "");
  EXPECT_EQ(name_of("/data/rgbd_dataset_freiburg1_desk/rgb"), "");
  EXPECT_EQ(name_of("/"), "");
}

TEST(RecordingCatalogue, TheFirstAcceptedFolderThatExistsIsTaken) {
  const testing::TemporaryFolder data;
  const CatalogueEntry* entry = find_catalogue_entry("dorm1_slow");
  ASSERT_NE(entry, nullptr);
  EXPECT_FALSE(catalogue_folder(*entry, data.path()).has_value());
  EXPECT_FALSE(catalogue_folder(*entry, {}).has_value());
  std::filesystem::create_directories(data.path() / "dorm1_slow");
  EXPECT_EQ(catalogue_folder(*entry, data.path()), data.path() / "dorm1_slow");
  std::filesystem::create_directories(data.path() / "dorm1" / "dorm1_slow");
  EXPECT_EQ(catalogue_folder(*entry, data.path()), data.path() / "dorm1" / "dorm1_slow");
}

// T_imu_color follows from the two published matrices; its translation is stated by the author on its own.
TEST(PublishedCalibration, Zr300AgreesWithTheAuthorsOwnExtrinsic) {
  const auto rig = catalogue_calibration("zr300_fmdataset");
  ASSERT_TRUE(rig.has_value()) << rig.error().message;
  EXPECT_FALSE(rig->source.empty());
  EXPECT_EQ(rig->color.pinhole.width_px, 640);
  EXPECT_DOUBLE_EQ(rig->color.pinhole.fx_px, 608.446);
  EXPECT_DOUBLE_EQ(rig->color.distortion.k1, 0.0644);
  EXPECT_EQ(rig->depth_units_per_metre, 1000.0);
  ASSERT_TRUE(rig->depth.has_value());
  EXPECT_DOUBLE_EQ(rig->depth->pinhole.fx_px, 583.98);
  // The left infrared camera lies 57 mm to the left of colour: its origin has a negative x in the colour
  // frame.
  EXPECT_LT((rig->depth->T_color_depth.translation - Vector3d(-0.05746, -0.001073, -0.002205)).norm(), 1e-9);
  ASSERT_TRUE(rig->imu.has_value());
  EXPECT_LT((rig->imu->T_imu_camera.translation - Vector3d(0.093775, 0.003211, 0.001930)).norm(), 2e-6);
  const Quaterniond stated = Quaterniond(0.999904, -0.010421, -0.005541, -0.007199).normalized();
  // The author's quaternion (qCM of rovio.info), its numbers read as Hamilton's.
  EXPECT_LT(rig->imu->T_imu_camera.rotation.angularDistance(stated), 2e-6);
  // The densities are roots of the covariances of calib.txt.
  const ImuNoise& noise = rig->imu->noise;
  EXPECT_NEAR(std::pow(noise.gyroscope_radps_sqrthz, 2), 1.22e-6, 1e-9);
  EXPECT_NEAR(std::pow(noise.accelerometer_mps2_sqrthz, 2), 5.88e-4, 1e-7);
  EXPECT_NEAR(std::pow(noise.gyroscope_bias_radps2_sqrthz, 2), 2.5e-9, 1e-12);
  EXPECT_NEAR(std::pow(noise.accelerometer_bias_mps3_sqrthz, 2), 4e-7, 1e-10);
}

TEST(PublishedCalibration, IclNuimHasAPositiveFocalLength) {
  const auto rig = catalogue_calibration("icl_nuim");
  ASSERT_TRUE(rig.has_value()) << rig.error().message;
  EXPECT_DOUBLE_EQ(rig->color.pinhole.fy_px, 480.0);
  EXPECT_EQ(rig->depth_units_per_metre, 5000.0);
  EXPECT_FALSE(rig->depth.has_value());
}

TEST(PublishedCalibration, AnUnknownNameNamesTheNearest) {
  const auto rig = catalogue_calibration("zr300_fmdatset");
  ASSERT_FALSE(rig.has_value());
  EXPECT_EQ(rig.error().code, ErrorCode::configuration);
  EXPECT_NE(rig.error().hint.find("zr300_fmdataset"), std::string::npos);
}

TEST(CatalogueEntryText, ReadsEveryKey) {
  const auto entry = parse_catalogue_entry(
      std::string(kSmall) +
          "camera = \"freiburg1\"\narchive_bytes = 5\ncolor_images = 3\ndepth_images = 2\nframes = 1\n"
          "duration_s = 1.5\nunverified = [\"licence\"]\narchive_sha256 = \"" +
          std::string(64, 'a') + "\"\n",
      "x.toml");
  ASSERT_TRUE(entry.has_value()) << entry.error().message;
  EXPECT_EQ(entry->folders, std::vector<std::string>{"f"});
  EXPECT_EQ(entry->archive_bytes, 5);
  EXPECT_EQ(entry->color_images, 3);
  EXPECT_EQ(entry->depth_images, 2);
  EXPECT_EQ(entry->frames, 1);
  EXPECT_EQ(entry->duration_s, 1.5);
  EXPECT_EQ(entry->archive_sha256.size(), 64U);
  EXPECT_EQ(entry->unverified, std::vector<std::string>{"licence"});
}

TEST(CatalogueEntryText, ABrokenFileNamesLineAndKey) {
  const auto expect_refused = [](const std::string& text, std::string_view words) {
    const auto entry = parse_catalogue_entry(text, "x.toml");
    ASSERT_FALSE(entry.has_value()) << text;
    EXPECT_EQ(entry.error().code, ErrorCode::configuration);
    EXPECT_NE(entry.error().message.find(words), std::string::npos) << entry.error().message;
  };
  const std::string small(kSmall);
  EXPECT_TRUE(parse_catalogue_entry(small, "x.toml").has_value());
  expect_refused(small + "colour_images = 3\n", "x.toml:10");
  expect_refused(small + "color_images = 0\n", "color_images");
  expect_refused(small + "color_images = \"3\"\n", "color_images");
  expect_refused(small + "duration_s = -1.0\n", "duration_s");
  expect_refused(small + "archive_sha256 = \"abc\"\n", "64");
  expect_refused(small + "download_note = \"by hand\"\n", "either download or download_note");
  expect_refused(small + "camera = \"freiburg1\"\ncalibration = \"icl_nuim\"\n",
                 "either camera or calibration");
  expect_refused(small + "[color]\nfx_px = 1\n", "[color]");
  expect_refused("kind = \"recording\"\nname = \"x\"\n", "'title' is missing");
  expect_refused("kind = \"calibration\"\n", "kind");
  expect_refused("folders = \"f\"\n", "folders");
  expect_refused("format = \"rosbag\"\n", "zr300");
}

}  // namespace
}  // namespace fusebench
