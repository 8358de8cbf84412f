// A tiny TUM RGB-D folder that a test may damage.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "datasets/images/image_files.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

/// Three frames of 8x6 pixels at 10.0, 10.1, 10.2 s and ground truth from 9.9 to 10.3 s, in a folder whose
/// name does not tell the camera.
class TumFolder {
 public:
  TumFolder() {
    for (int i = 0; i < 3; ++i) {
      write_color(i, ColorImage(8, 6, Rgb{10, 20, 30}));
      write_depth(i, Image<std::uint16_t>(8, 6, static_cast<std::uint16_t>(5000 + i)));
    }
    write("rgb.txt", "# colour\n10.0 rgb/0.png\n10.1 rgb/1.png\n10.2 rgb/2.png\n");
    write("depth.txt", "# depth\n10.01 depth/0.png\n10.11 depth/1.png\n10.19 depth/2.png\n");
    std::string truth = "# truth\n";
    for (int i = 0; i <= 8; ++i) truth += std::to_string(9.9 + 0.05 * i) + " 1 2 3 0 0 0 1\n";
    write("groundtruth.txt", truth);
  }

  void write(const std::string& name, std::string_view content) const { folder_.write(name, content); }
  void write_color(int index, const ColorImage& image) const {
    write("rgb/" + std::to_string(index) + ".png", "");  // makes the folder
    EXPECT_TRUE(images::write_png(path() / "rgb" / (std::to_string(index) + ".png"), image));
  }
  void write_depth(int index, const Image<std::uint16_t>& image) const {
    write("depth/" + std::to_string(index) + ".png", "");
    EXPECT_TRUE(images::write_png(path() / "depth" / (std::to_string(index) + ".png"), image));
  }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// A recording of the real world, committed: tests/golden/tum_freiburg1_rpy_5frames.
inline std::filesystem::path golden_tum_folder() {
  return repository_root() / "tests" / "golden" / "tum_freiburg1_rpy_5frames";
}

}  // namespace fusebench::testing
