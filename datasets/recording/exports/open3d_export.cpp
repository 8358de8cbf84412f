#include <fmt/format.h>

#include <string>

#include "datasets/images/image_files.hpp"
#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "datasets/recording/exports/sensor_tables.hpp"

namespace fusebench::exports {

namespace {

std::string intrinsic_json(const PinholeCamera& camera) {
  return fmt::format(
      "{{\n  \"width\": {},\n  \"height\": {},\n"
      "  \"intrinsic_matrix\": [{}, 0, 0, 0, {}, 0, {}, {}, 1]\n}}\n",
      camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
}

/// What is not said here has the program's own default.
std::string config_json() {
  return fmt::format(
      "{{\n  \"name\": \"exported recording\",\n  \"path_dataset\": \".\",\n"
      "  \"path_intrinsic\": \"intrinsic.json\",\n  \"depth_scale\": {}\n}}\n",
      kOpen3dDepth.units_per_metre);
}

}  // namespace

Result<WrittenExport> write_open3d(const recording::Recording& recording, const ExportPlace& place) {
  if (const auto created = place.create_folders({"color", "depth"}); !created)
    return tl::unexpected(created.error());
  const auto counts =
      for_each_frame(recording, kOpen3dDepth, [&](const QuantisedFrame& frame) -> Result<void> {
        const std::string name = fmt::format("{:06}.png", frame.index);
        if (auto written = images::write_png(place.file("color/" + name), frame.color); !written)
          return written;
        return images::write_png(place.file("depth/" + name), frame.depth);
      });
  if (!counts) return tl::unexpected(counts.error());
  const auto written = place.write({{"intrinsic.json", intrinsic_json(recording.rig.camera)},
                                    {"config.json", config_json()},
                                    {"frame_times.txt", frame_time_table(recording.frames)}});
  if (!written) return tl::unexpected(written.error());
  return WrittenExport{
      *counts,
      {"config.json", "intrinsic.json"},
      {"Open3D: in the folder, run_system.py --config config.json --make --register --refine --integrate",
       "frames have numbers and no time: frame_times.txt has the stamp of each",
       "its own default leaves out depth beyond 3 m; config.json contains further notes"},
      "intrinsic.json"};
}

}  // namespace fusebench::exports
