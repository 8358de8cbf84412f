#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "datasets/images/image_files.hpp"
#include "datasets/recording/exports/export_formats.hpp"
#include "datasets/recording/exports/quantised_frames.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"

namespace fusebench::exports {

namespace {

constexpr int kJpegQuality = 95;
constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;

std::uint64_t microseconds(std::int64_t time_ns) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns, 0) / kNanosecondsPerMicrosecond);
}

Result<std::string> frame_bytes(const QuantisedFrame& frame) {
  const auto jpeg = images::encode_jpeg(frame.color, kJpegQuality);
  if (!jpeg) return tl::unexpected(jpeg.error());
  return image_logs::sens_bytes(image_logs::SensFrame{std::nullopt, microseconds(frame.entry.timestamp_ns),
                                                      microseconds(frame.entry.depth_timestamp_ns),
                                                      std::string(jpeg->begin(), jpeg->end()), frame.depth});
}

}  // namespace

Result<WrittenExport> write_sens(const recording::Recording& recording, const ExportPlace& place) {
  const std::filesystem::path file = place.file(place.name());
  std::ofstream stream(file, std::ios::binary);
  const auto put = [&](const std::string& bytes) -> Result<void> {
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream) return cannot_be_written(file);
    return {};
  };
  image_logs::SensHeader header{"fusebench", recording.rig.camera, recording.rig.camera};
  header.frames = recording.frames.size();
  if (const auto written = put(image_logs::sens_bytes(header)); !written)
    return tl::unexpected(written.error());
  const auto counts = for_each_frame(
      recording, kSensDepth, [&](const QuantisedFrame& frame) { return frame_bytes(frame).and_then(put); });
  if (!counts) return tl::unexpected(counts.error());
  std::string no_imu_frames;
  image_logs::append_number<std::uint64_t>(no_imu_frames, 0);
  if (const auto written = put(no_imu_frames); !written) return tl::unexpected(written.error());
  stream.close();
  if (!stream) return cannot_be_written(file);
  return WrittenExport{
      *counts,
      {place.name()},
      {fmt::format("BundleFusion: in its parameter file, s_sensorIdx = 8 and s_binaryDumpSensorFile = \"{}\"",
                   place.name()),
       fmt::format("colour is JPEG of quality {}, which changes its pixels a little", kJpegQuality),
       "the file holds no poses: the true ones are not for the program that is to estimate them"}};
}

}  // namespace fusebench::exports
