// Tiny ICL-NUIM folders that a test may damage.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

/// Images of 8x6 pixels, so the camera must be given.
inline recording::ReadOptions icl_small_camera() {
  recording::ReadOptions options;
  calibration::CalibratedCamera camera;
  camera.pinhole = {0, 0, 10, 11, 3.5, 2.5};
  options.camera = camera;
  return options;
}

/// Frames 0 to 3, of which 0 has no pose, in the TUM-compatible packing; frame k has depth 5000 + k.
class IclFolder {
 public:
  IclFolder() {
    for (int k = 0; k < 4; ++k) write_images(k);
    write("associations.txt",
          "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n2 depth/2.png 2 rgb/2.png\n"
          "3 depth/3.png 3 rgb/3.png\n");
    write("livingRoom1.gt.freiburg",
          "1 0 0 -2.25 0 0 0 1\n2 0.1 0.2 -2.15 0.1 0.2 0.3 0.9273618495495703\n3 0.2 0.4 -2 0 0 0 1\n");
  }

  void write_images(int k) const {
    const std::string name = std::to_string(k) + ".png";
    write("rgb/" + name, "");
    write("depth/" + name, "");
    const auto value = static_cast<std::uint16_t>(5000 + k);
    EXPECT_TRUE(images::write_png(path() / "rgb" / name,
                                  ColorImage(8, 6, Rgb{10, 20, static_cast<std::uint8_t>(k)})));
    EXPECT_TRUE(images::write_png(path() / "depth" / name, Image<std::uint16_t>(8, 6, value)));
  }
  void write(const std::string& name, std::string_view content) const { folder_.write(name, content); }
  void remove(const std::string& name) const { std::filesystem::remove(path() / name); }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  [[nodiscard]] Result<recording::Recording> open(
      const recording::ReadOptions& options = icl_small_camera()) const {
    return datasets::open_recording(path(), {"", options});
  }
  [[nodiscard]] Result<recording::Recording> open_as_icl() const {
    return datasets::open_recording(path(), {"icl", icl_small_camera()});
  }

 private:
  TemporaryFolder folder_;
};

/// The folder FUSEBENCH_DATA / name; nothing if it is not there.
inline std::optional<std::filesystem::path> shared_recording(const std::string& name) {
  const char* data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) return std::nullopt;
  const std::filesystem::path folder = std::filesystem::path(data) / name;
  return std::filesystem::is_directory(folder) ? std::optional(folder) : std::nullopt;
}

/// The message of a refusal with the given code.
inline std::string refusal_message(const Result<recording::Recording>& recording, ErrorCode code) {
  if (recording) {
    ADD_FAILURE() << "was accepted";
    return {};
  }
  EXPECT_EQ(recording.error().code, code) << recording.error().message;
  return recording.error().message + " | " + recording.error().hint;
}

inline void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

}  // namespace fusebench::testing
