#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "datasets/recording/image_logs/little_endian.hpp"
#include "datasets/recording/image_logs/zlib_bytes.hpp"

namespace fusebench::exports {

namespace {

constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;

/// int64 stamp in microseconds, int32 bytes of depth, int32 bytes of colour; depth: a zlib stream of uint16
/// millimetres, or plain if there are 2 w h bytes; colour: plain RGB. All numbers are little-endian.
std::string bytes_of(const QuantisedFrame& frame) {
  const std::size_t plain_size = frame.depth.data.size() * sizeof(std::uint16_t);
  std::string depth = image_logs::packed_depth(frame.depth);
  // A stream of just that length would be taken for plain values.
  if (depth.size() == plain_size)
    depth.assign(reinterpret_cast<const char*>(frame.depth.data.data()), plain_size);
  const std::size_t color_size = frame.color.data.size() * sizeof(Rgb);
  std::string bytes;
  image_logs::append_number(bytes, frame.entry.timestamp_ns / kNanosecondsPerMicrosecond);
  image_logs::append_number(bytes, static_cast<std::int32_t>(depth.size()));
  image_logs::append_number(bytes, static_cast<std::int32_t>(color_size));
  bytes += depth;
  bytes.append(reinterpret_cast<const char*>(frame.color.data.data()), color_size);
  return bytes;
}

Result<void> check_size(const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  if (camera.width_px == kWidth_px && camera.height_px == kHeight_px) return {};
  return fail(ErrorCode::usage,
              fmt::format("'{}': images of {}x{} pixels (allowed in .klg: {}x{})", recording.name,
                          camera.width_px, camera.height_px, kWidth_px, kHeight_px),
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
  std::string header;  // how many frames
  image_logs::append_number(header, static_cast<std::int32_t>(count + 1));
  if (const auto written = put(header); !written) return tl::unexpected(written.error());
  auto counts = for_each_frame(recording, kKlgDepth, [&](const QuantisedFrame& frame) -> Result<void> {
    const std::string bytes = bytes_of(frame);
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
