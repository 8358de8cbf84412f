// Every list and table of every format, malformed in every way: a clear error or the right values, never
// anything in between.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/io/row_text.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/formats/tum/tum_lists.hpp"
#include "datasets/recording/formats/zr300/zr300_lists.hpp"
#include "datasets/recording/reading/associated_row.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "tests/datasets/malformed_text.hpp"

namespace fusebench {

using namespace io;
using namespace trajectory;
using namespace recording;
using namespace reading;
using namespace formats::tum;
using namespace formats::zr300;

namespace {

namespace fs = std::filesystem;
using namespace testing;

/// What was read, printed.
using Reading = Result<std::string>;

template <class Rows, class Print>
Reading print_rows(const Result<Rows>& rows, const Print& print) {
  if (!rows) return tl::unexpected(rows.error());
  std::string text;
  for (const auto& row : *rows) text += print(row) + "\n";
  return text;
}

std::string print(const Vector3d& v) { return fmt::format(" {} {} {}", v.x(), v.y(), v.z()); }
std::string print_image(const ListedImage& i) {
  return fmt::format("{} {}", i.timestamp_ns, i.file.string());
}

struct Table {
  std::string name;
  std::string file;
  Rows rows;
  std::size_t first_number = 1;  ///< column; behind the last one if only the time is a number
  bool stamps_may_repeat = false;
  bool is_optional = false;  ///< its absence is no error
  std::function<Reading(const fs::path& folder)> read;
  bool any_number = false;   ///< the columns have no range that is checked
  bool lost_frames = false;  ///< missing numbers are no error
};

/// What a list of tests shows.
void PrintTo(const Table& table, std::ostream* stream) { *stream << table.file; }

Reading read_trajectory(const fs::path& folder) {
  std::vector<std::string> warnings;
  const auto poses = read_tum_trajectory(folder / "trajectory.txt", warnings);
  if (!poses) return tl::unexpected(poses.error());
  return tum_text(*poses);
}

Reading read_accelerometer(const fs::path& folder) {
  std::vector<std::string> warnings;
  return print_rows(read_tum_accelerometer(folder / "accelerometer.txt", warnings),
                    [](const AccelerometerSample& sample) {
                      return std::to_string(sample.timestamp_ns) + print(sample.specific_force_mps2);
                    });
}

Reading read_images(const fs::path& folder) {
  std::vector<std::string> warnings;
  return print_rows(read_image_list(folder / "rgb.txt", warnings), print_image);
}

Reading read_euroc_images(const fs::path& folder) {
  std::vector<std::string> warnings;
  return print_rows(read_image_list(folder / "data.csv", folder / "color", TimeUnit::nanoseconds, warnings),
                    print_image);
}

Reading read_truth(const fs::path& folder) {
  Recording recording;
  recording.frames.resize(1);
  recording.frames[0].timestamp_ns = 1'200'000'000;
  if (const auto read = read_ground_truth_beside(folder, recording); !read)
    return tl::unexpected(read.error());
  return tum_text(recording.ground_truth);
}

template <class Read>
Reading read_imu_with(Read read, const fs::path& folder) {
  Recording recording;
  if (const Result<void> done = read(folder, recording); !done) return tl::unexpected(done.error());
  std::string text;
  for (const ImuSample& s : recording.imu) {
    text += std::to_string(s.timestamp_ns) + print(s.angular_velocity_radps) + print(s.specific_force_mps2) +
            "\n";
  }
  return text;
}

Reading read_timestamps(const fs::path& folder) {
  Recording recording;
  const auto images = read_zr300_timestamps(folder, false, recording);
  if (!images) return tl::unexpected(images.error());
  return *print_rows(Result<std::vector<ListedImage>>(images->color), print_image) +
         *print_rows(Result<std::vector<ListedImage>>(images->depth), print_image);
}

Reading read_associations(const fs::path& folder) {
  std::string text;
  const auto use = [&](const TextTable&, const AssociatedRow& row) -> Result<void> {
    text += row.color_stamp + " " + row.color_file.string() + " " + row.depth_stamp + " " +
            row.depth_file.string() + "\n";
    return {};
  };
  std::vector<std::string> warnings;
  const auto read = for_each_associated_row(folder / "associated.txt", use, warnings);
  if (!read) return tl::unexpected(read.error());
  return text;
}

const Rows kPoses = {"1.0 0 0 0 0 0 0 1", "1.1 0.5 -2 3e-1 0 0 1 0", "1.2 1 1 1 0.5 0.5 0.5 0.5",
                     "1.3 1 1 1 0.5 0.5 0.5 0.5", "1.4 1 2 3 0 0.6 0 0.8"};
const Rows kAcceleration = {"1.0 0.1 -9.8 0.2", "1.1 0.1 -9.7 0.2", "1.2 0 -9.8 0", "1.3 0 -9.8 0",
                            "1.4 1 2 3"};

/// The same samples, their times counted in another unit.
Rows imu_rows(std::int64_t spacing) {
  Rows rows;
  for (int i = 0; i < 5; ++i)
    rows.push_back(fmt::format("{} {} -0.2 0.3 0.1 9.8 {}", (i + 1) * spacing, 0.1 * i, i));
  return rows;
}

Rows image_rows(std::string_view pattern) {
  Rows rows;
  for (int i = 1; i <= 5; ++i) rows.push_back(fmt::format(fmt::runtime(pattern), 33333 * i, i));
  return rows;
}

std::vector<Table> tables() {
  const auto imu = [](const fs::path& folder) { return read_imu_with(read_imu_beside, folder); };
  const auto zr300_imu = [](const fs::path& folder) { return read_imu_with(read_zr300_imu, folder); };
  return {
      {"trajectory", "trajectory.txt", kPoses, 1, false, false, read_trajectory, true, true},
      {"groundtruth", "groundtruth.txt", kPoses, 1, true, true, read_truth, false, true},
      {"accelerometer", "accelerometer.txt", kAcceleration, 1, false, false, read_accelerometer},
      {"imu_csv", "imu.csv", imu_rows(5'000'000), 1, false, true, imu},
      {"tum_images", "rgb.txt", image_rows("{0} color/{1}.png"), 2, false, false, read_images},
      {"euroc_images", "data.csv", image_rows("{0} {1}.png"), 2, false, false, read_euroc_images},
      {"zr300_images", "TIMESTAMP.txt", image_rows("{0} {1}.png {1}.png"), 3, false, false, read_timestamps},
      {"zr300_imu", "IMU.txt", imu_rows(5000), 1, true, false, zr300_imu},
      {"associations", "associated.txt", image_rows("{0} color/{1}.png {0} depth/{1}.png"), 4, true, false,
       read_associations},
  };
}

class MalformedTable : public ::testing::TestWithParam<Table> {
 protected:
  MalformedTable() {
    for (int i = 1; i <= 5; ++i) {
      folder_.write(fmt::format("color/{}.png", i), "");
      folder_.write(fmt::format("depth/{}.png", i), "");
    }
  }
  Reading read(std::string_view content) const {
    folder_.write(table_.file, content);
    return table_.read(folder_.path());
  }
  void expect_same(std::string_view content, std::string_view as) const {
    const Reading expected = read(as);
    ASSERT_TRUE(expected) << expected.error().message;
    const Reading got = read(content);
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(*got, *expected);
  }
  void expect_refused(std::string_view content, int line, std::string_view part) const {
    const Reading got = read(content);
    ASSERT_FALSE(got) << *got;
    expect_refusal(got.error(), file_, line, part);
  }
  [[nodiscard]] std::string with_field_in_row_1(std::size_t column, std::string_view field) const {
    return "# a comment\n" + joined(with_row(table_.rows, 1, with_field(table_.rows[1], column, field)));
  }

  const Table& table_ = GetParam();
  TemporaryFolder folder_;
  fs::path file_ = folder_.path() / table_.file;
};

TEST_P(MalformedTable, UnusualButSoundFilesReadTheSame) {
  for (const Malformation& variant : unusual_but_sound()) {
    SCOPED_TRACE(variant.name);
    expect_same(variant.text(table_.rows), joined(table_.rows));
  }
}

TEST_P(MalformedTable, BrokenRowsAreNamed) {
  for (const Malformation& malformation : malformed_tables()) {
    SCOPED_TRACE(malformation.name);
    expect_refused(malformation.text(table_.rows), malformation.line, malformation.part);
  }
}

TEST_P(MalformedTable, WhatIsNoTimeIsRefused) {
  if (table_.name == "associations") GTEST_SKIP() << "the formats that use this list read its stamps";
  for (const std::string& word : not_numbers()) {
    SCOPED_TRACE(word);
    expect_refused(with_field_in_row_1(0, word), 3, "timestamp: ");
  }
  for (const char* huge : {"99999999999999999999", "1e300"}) {
    SCOPED_TRACE(huge);
    expect_refused(with_field_in_row_1(0, huge), 3, "146 years");
  }
}

TEST_P(MalformedTable, TimeMustRunForwards) {
  if (table_.name == "associations") GTEST_SKIP() << "the formats that use this list read its stamps";
  Rows swapped = table_.rows;
  std::swap(swapped[2], swapped[3]);
  expect_refused(joined(swapped), 4, "time runs backwards");
  Rows repeated = table_.rows;
  repeated.insert(repeated.begin() + 2, repeated[1]);
  if (table_.stamps_may_repeat) return expect_same(joined(repeated), joined(table_.rows));
  expect_refused(joined(repeated), 3, "is the same as that of line 2");
}

TEST_P(MalformedTable, NumbersAreFiniteDecimals) {
  const auto columns = static_cast<std::size_t>(std::ranges::count(table_.rows[1], ' ')) + 1;
  for (std::size_t column = table_.first_number; column < columns; ++column) {
    for (const std::string& word : not_numbers()) {
      if (table_.lost_frames && io::is_missing(word)) continue;
      SCOPED_TRACE(fmt::format("column {}: {}", column, word));
      expect_refused(with_field_in_row_1(column, word), 3, "expected a finite number, got '");
    }
  }
  if (table_.first_number >= columns) return;
  const std::pair<std::string, const char*> unusual[] = {{"+0.5", "0.5"},
                                                         {".5", "0.5"},
                                                         {"5.", "5"},
                                                         {"-0", "-0.0"},
                                                         {"1e-320", "9.99989e-321"},
                                                         {"0." + std::string(400, '3'), "0.3333333333333333"},
                                                         {"5E-1", "5e-1"},
                                                         {"000000.25", "0.25"},
                                                         {"1" + std::string(2, '0'), "1e2"}};
  for (const auto& [field, same] : unusual) {
    SCOPED_TRACE(field);
    expect_same(with_field_in_row_1(1, field), with_field_in_row_1(1, same));
  }
  if (table_.any_number)
    expect_same(with_field_in_row_1(1, "2" + std::string(11, '0')), with_field_in_row_1(1, "2e11"));
  for (const std::string& huge : {"2" + std::string(20, '0'), std::string("1e308")})
    expect_refused(with_field_in_row_1(1, huge), 3, "(allowed");
}

TEST_P(MalformedTable, WhatIsNoFileIsMissing) {
  const Reading absent = table_.read(folder_.path());
  EXPECT_EQ(absent.has_value(), table_.is_optional);
  if (!absent) {
    expect_refusal(absent.error(), file_, 0, "no such file");
    EXPECT_EQ(absent.error().code, ErrorCode::data_missing);
  }
  fs::create_directory(file_);
  const Reading directory = table_.read(folder_.path());
  ASSERT_FALSE(directory);
  expect_refusal(directory.error(), file_, 0, "cannot be read as a file");
  fs::remove(file_);
  if (geteuid() == 0) return;  // root may read everything
  folder_.write(table_.file, joined(table_.rows));
  fs::permissions(file_, fs::perms::none);
  EXPECT_FALSE(table_.read(folder_.path()));
}

INSTANTIATE_TEST_SUITE_P(All, MalformedTable, ::testing::ValuesIn(tables()),
                         [](const auto& test) { return test.param.name; });

TEST(MalformedList, NamesOfImages) {
  const TemporaryFolder folder;
  folder.write("rgb/1.png", "");
  folder.write("outside.png", "");
  const auto read = [&](std::string_view name) {
    std::vector<std::string> warnings;
    return read_image_list(folder.write("rgb/rgb.txt", fmt::format("# images\n1.0 1.png\n2.0 {}\n", name)),
                           warnings);
  };
  const fs::path list = folder.path() / "rgb" / "rgb.txt";
  for (const std::string& name :
       {std::string("./1.png"), std::string("../rgb//1.png"), (folder.path() / "rgb" / "1.png").string()}) {
    EXPECT_TRUE(read(name)) << name;
  }
  // What a recording from a stranger can have read is its own.
  for (const std::string& name : {std::string("../outside.png"), (folder.path() / "outside.png").string(),
                                  std::string("x/../../outside.png"), std::string("../rgb2/../outside.png"),
                                  std::string("/dev/zero"), std::string("../none.png")})
    expect_refusal(read(name).error(), list, 3, "is outside of ");
  expect_refusal(read("a name.png").error(), list, 3, "expected 2 columns: timestamp filename, got 3");
  for (const std::string& name :
       {std::string("none.png"), std::string("."), std::string("1.png/"), std::string("1.PNG"),
        std::string("caf\xE9.png"), std::string("\x1B[31m.png"), std::string(60'000, 'x')}) {
    const auto refused = read(name);
    ASSERT_FALSE(refused) << name;
    expect_refusal(refused.error(), list, 3, "does not exist");
    EXPECT_EQ(refused.error().code, ErrorCode::data_missing);
  }
}

}  // namespace
}  // namespace fusebench
