// Images that change after their recording was opened, as a download that goes on changes them: what runs
// under the fingerprint of the opening must be the images of the opening.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "datasets/open_recording.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"

namespace fusebench {

using namespace io;
using namespace images;
using namespace calibration;
using namespace recording;
using namespace datasets;

namespace {

using testing::read_bytes;
using testing::TemporaryFolder;
using testing::TumFolder;

Recording opened(const std::filesystem::path& folder) {
  ReadOptions options;
  options.camera = CalibratedCamera{{0, 0, 10, 11, 3.5, 2.5}, {}, {}};
  auto recording = open_recording(folder, {"", options});
  EXPECT_TRUE(recording) << recording.error().message;
  return std::move(*recording);
}

/// The file is named, and what to do.
void expect_refused(const Recording& recording, std::size_t frame, const std::filesystem::path& file,
                    std::string_view difference) {
  const auto loaded = recording.load_frame(frame);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::data_corrupt);
  EXPECT_EQ(loaded.error().message,
            fmt::format("{}: has changed since the recording was opened ({}); wait until it is written "
                        "completely and run again",
                        file.string(), difference));
}

TEST(ChangedImages, OtherPixelsAreRefusedAndTheNextOpeningHasAnotherFingerprint) {
  const TumFolder folder;
  const Recording recording = opened(folder.path());
  const auto color = folder.path() / "rgb" / "1.png", depth = folder.path() / "depth" / "2.png";
  const auto size = [](const std::filesystem::path& file) { return std::filesystem::file_size(file); };
  const auto color_before = size(color), depth_before = size(depth);
  ColorImage image(8, 6, Rgb{10, 20, 30});
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i][i % 3] = static_cast<std::uint8_t>(5 * i);
  folder.write_color(1, image);
  ASSERT_NE(size(color), color_before);
  Image<std::uint16_t> values(8, 6);
  for (std::size_t i = 0; i < values.data.size(); ++i) values.data[i] = static_cast<std::uint16_t>(977 * i);
  folder.write_depth(2, values);
  ASSERT_NE(size(depth), depth_before);

  EXPECT_TRUE(recording.load_frame(0));
  expect_refused(recording, 1, color, fmt::format("{} bytes, before {}", size(color), color_before));
  expect_refused(recording, 2, depth, fmt::format("{} bytes, before {}", size(depth), depth_before));

  const Recording again = opened(folder.path());
  EXPECT_NE(again.fingerprint, recording.fingerprint);
  for (std::size_t frame = 0; frame < 3; ++frame) EXPECT_TRUE(again.load_frame(frame));
}

TEST(ChangedImages, AnImageOfTheSameSizeIsRefused) {
  const TumFolder folder;
  const Recording recording = opened(folder.path());
  const auto file = folder.path() / "depth" / "0.png";
  const std::string before = read_bytes(file);
  folder.write_depth(0, Image<std::uint16_t>(8, 6, 5003));
  ASSERT_EQ(std::filesystem::file_size(file), before.size());
  expect_refused(recording, 0, file, fmt::format("other content in its {} bytes", before.size()));
}

TEST(ChangedImages, AFileThatIsBeingWrittenIsRefusedAsChangedAndNotAsDamaged) {
  const TumFolder folder;
  const Recording recording = opened(folder.path());
  const auto file = folder.path() / "rgb" / "2.png";
  const std::string before = read_bytes(file);
  for (const std::size_t written : {std::size_t{0}, std::size_t{20}, before.size() - 1}) {
    folder.write("rgb/2.png", before.substr(0, written));
    expect_refused(recording, 2, file, fmt::format("{} bytes, before {}", written, before.size()));
  }
  folder.write("rgb/2.png", before);
  EXPECT_TRUE(recording.load_frame(2)) << "the same bytes, written again";
  std::filesystem::remove(file);
  const auto missing = recording.load_frame(2);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::data_missing);
  std::filesystem::create_directory(file);
  expect_refused(recording, 2, file, "it cannot be read any more");
}

TEST(ChangedImages, APartOfARecordingIsOfItsOwnFrames) {
  const TumFolder folder;
  Recording recording = opened(folder.path());
  ASSERT_TRUE(select_frames(recording, 1, 3));
  folder.write_depth(0, Image<std::uint16_t>(8, 6, 7));
  EXPECT_TRUE(recording.load_frame(0)) << "frame 1 of the whole";
  folder.write_depth(2, Image<std::uint16_t>(8, 6, 7));
  EXPECT_TRUE(recording.load_frame(0));
  EXPECT_FALSE(recording.load_frame(1));
}

TEST(ChangedImages, AnImageThatIsNoPlainPngIsCheckedAsWell) {
  const TemporaryFolder folder;
  const auto write = [&](const Rgb& color) {
    const auto jpeg = encode_jpeg(ColorImage(24, 16, color), 95);
    EXPECT_TRUE(jpeg);
    return folder.write("c.jpg", {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
  };
  const auto file = write({200, 100, 50});
  const ContentHash before = content_hash(read_bytes(file));
  EXPECT_TRUE(read_color(file, ImageSize{24, 16}, before));
  write({50, 100, 200});
  const auto changed = read_color(file, ImageSize{24, 16}, before);
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().message.find("c.jpg: has changed since"), std::string::npos);
}

TEST(ChangedImages, TheHashOfAFileIsThatOfItsBytes) {
  const TemporaryFolder folder;
  std::string bytes(200'000, 'x');  // several of the pieces that files are read in
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i >> 7);
  Fingerprint fingerprint;
  fingerprint.add("something before");
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, bytes.size()}) {
    const std::string content = bytes.substr(0, size);
    const auto added = fingerprint.add_file(folder.write("a", content));
    ASSERT_TRUE(added);
    EXPECT_EQ(*added, content_hash(content));
    EXPECT_EQ(added->bytes, size);
  }
}

}  // namespace
}  // namespace fusebench
