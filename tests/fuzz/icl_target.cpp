// The text files of ICL-NUIM: the renderer's cameras and ray lengths, and the list of its images.
#include <algorithm>
#include <cmath>

#include "datasets/recording/formats/icl/icl_povray_files.hpp"
#include "datasets/recording/reading/associated_row.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace io;
using namespace reading;
using namespace formats::icl;

namespace {

void check_camera(const std::filesystem::path& file) {
  const auto camera = read_povray_camera(file);
  if (!camera) return check_error(camera.error(), file);
  const SE3 pose = pose_of(*camera, 1);
  check(pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-9,
        "a pose is rigid and finite");
}

void check_depth(const std::filesystem::path& file) {
  const auto depth_m = read_povray_depth(file, PinholeCamera{3, 2, 2, 2, 1, 0.5}, 1);
  if (!depth_m) return check_error(depth_m.error(), file);
  check(depth_m->data.size() == 6, "an image has all its pixels");
  check(std::ranges::all_of(depth_m->data, [](float z_m) { return z_m >= 0 && z_m <= 1000; }),
        "depth is positive and finite");
}

void check_list(const std::filesystem::path& file) {
  int rows = 0;
  std::vector<std::string> warnings;
  const auto use = [&](const TextTable&, const AssociatedRow& row) {
    ++rows;
    check(!row.color_stamp.empty() && !row.depth_stamp.empty(), "a row has both stamps");
    return Result<void>{};
  };
  const auto read = for_each_associated_row(file, use, warnings);
  if (!read) return check_error(read.error(), file);
  check(rows > 0, "a list has rows");
  check(first_associated_row(file).has_value(), "the first row is read as well");
}

}  // namespace

void icl(std::string_view bytes) {
  static const MemoryFile file("scene_00_0000.txt");
  static const bool has_image = (file.also_call("depth/0.png"), true);
  static_cast<void>(has_image);
  file.write(bytes);
  check_camera(file.path());
  check_depth(file.path());
  check_list(file.path());
}

}  // namespace fusebench::fuzz
