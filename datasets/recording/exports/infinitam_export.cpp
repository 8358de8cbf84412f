#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "datasets/recording/exports/sensor_tables.hpp"

namespace fusebench::exports {

namespace {

std::string calibration_text(const PinholeCamera& camera) {
  const std::string one = fmt::format("{} {}\n{} {}\n{} {}\n\n", camera.width_px, camera.height_px,
                                      camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  return one + one + "1 0 0 0\n0 1 0 0\n0 0 1 0\n\naffine 0.001 0\n";
}

/// Binary Netpbm: red, green, blue.
std::string ppm_bytes(const ColorImage& image) {
  std::string bytes = fmt::format("P6\n{} {}\n255\n", image.width, image.height);
  bytes.append(reinterpret_cast<const char*>(image.data.data()), image.data.size() * sizeof(Rgb));
  return bytes;
}

/// Binary Netpbm: big-endian 16-bit values.
std::string pgm_bytes(const Image<std::uint16_t>& image) {
  std::string bytes = fmt::format("P5\n{} {}\n65535\n", image.width, image.height);
  bytes.reserve(bytes.size() + 2 * image.data.size());
  for (const std::uint16_t value : image.data) {
    bytes += static_cast<char>(value >> 8);
    bytes += static_cast<char>(value & 0xFF);
  }
  return bytes;
}

}  // namespace

Result<WrittenExport> write_infinitam(const recording::Recording& recording, const ExportPlace& place) {
  if (const auto created = place.create_folders({"color", "depth"}); !created)
    return tl::unexpected(created.error());
  const auto counts =
      for_each_frame(recording, kInfinitamDepth, [&](const QuantisedFrame& frame) -> Result<void> {
        return place.write({{fmt::format("color/{:04}.ppm", frame.index), ppm_bytes(frame.color)},
                            {fmt::format("depth/{:04}.pgm", frame.index), pgm_bytes(frame.depth)}});
      });
  if (!counts) return tl::unexpected(counts.error());
  const auto written = place.write({{"calib.txt", calibration_text(recording.rig.camera)},
                                    {"frame_times.txt", frame_time_table(recording.frames)}});
  if (!written) return tl::unexpected(written.error());
  return WrittenExport{*counts,
                       {"calib.txt", "color/%04i.ppm", "depth/%04i.pgm"},
                       {"InfiniTAM: InfiniTAM_cli calib.txt color/%04i.ppm depth/%04i.pgm",
                        "frames have numbers and no time: frame_times.txt has the stamp of each"},
                       "calib.txt"};
}

}  // namespace fusebench::exports
