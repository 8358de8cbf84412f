#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "datasets/exports/export_formats.hpp"
#include "datasets/exports/quantised_frames.hpp"
#include "datasets/image_logs/klg_log.hpp"

namespace fusebench::exports {

namespace {

constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;

Result<void> check_size(const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  if (camera.width_px == image_logs::kKlgWidth_px && camera.height_px == image_logs::kKlgHeight_px) return {};
  return fail(
      ErrorCode::usage,
      fmt::format("'{}': images of {}x{} pixels (allowed in .klg: {}x{})", recording.name, camera.width_px,
                  camera.height_px, image_logs::kKlgWidth_px, image_logs::kKlgHeight_px),
      "ElasticFusion assumes that size: take another --format");
}

Result<DepthCounts> write_frames(const recording::Recording& recording, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  const auto put = [&](const std::string& bytes) -> Result<void> {
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream) return cannot_be_written(file);
    return {};
  };
  const std::size_t count = recording.frames.size();
  if (const auto written = put(image_logs::klg_header(count + 1)); !written)
    return tl::unexpected(written.error());
  auto counts = for_each_frame(recording, kKlgDepth, [&](const QuantisedFrame& frame) -> Result<void> {
    const std::string bytes = image_logs::klg_bytes(
        {frame.entry.timestamp_ns / kNanosecondsPerMicrosecond, frame.depth, frame.color, {}});
    if (auto written = put(bytes); !written || frame.index + 1 < count) return written;
    return put(bytes);
  });
  stream.close();
  if (counts && !stream) return cannot_be_written(file);
  return counts;
}

}  // namespace

Result<WrittenExport> write_klg(const recording::Recording& recording, const ExportPlace& place) {
  if (const auto fits = check_size(recording); !fits) return tl::unexpected(fits.error());
  const PinholeCamera& camera = recording.rig.camera;
  const std::string calibration = place.beside("calibration.txt");
  const auto calibrated = place.write(
      {{calibration, fmt::format("{} {} {} {}\n", camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px)}});
  if (!calibrated) return tl::unexpected(calibrated.error());
  const auto counts = write_frames(recording, place.file(place.name()));
  if (!counts) return tl::unexpected(counts.error());
  return WrittenExport{
      *counts,
      {place.name(), calibration},
      {fmt::format("ElasticFusion: ElasticFusion -l {} -cal {} -q; colour is red, green, blue: no -f",
                   place.name(), calibration),
       fmt::format(
           "the file counts {} frames: the last one is written twice, since the reader stops one early",
           recording.frames.size() + 1)},
      calibration};
}

}  // namespace fusebench::exports
