#include "datasets/exports/klg_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <utility>

#include "datasets/exports/quantised_frames.hpp"
#include "datasets/exports/zlib_bytes.hpp"

namespace fusebench::exports {

namespace {

constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;

std::string frame_bytes(const QuantisedFrame& frame) {
  const std::size_t plain_size = frame.depth.data.size() * sizeof(std::uint16_t);
  std::string depth = packed_depth(frame.depth);
  // A stream of just that length would be taken for plain values.
  if (depth.size() == plain_size)
    depth.assign(reinterpret_cast<const char*>(frame.depth.data.data()), plain_size);
  const std::size_t color_size = frame.color.data.size() * sizeof(Rgb);
  std::string bytes;
  append_number<std::int64_t>(bytes, frame.entry.timestamp_ns / kNanosecondsPerMicrosecond);
  append_number(bytes, static_cast<std::int32_t>(depth.size()));
  append_number(bytes, static_cast<std::int32_t>(color_size));
  bytes += depth;
  bytes.append(reinterpret_cast<const char*>(frame.color.data.data()), color_size);
  return bytes;
}

Result<void> check_size(const recording::Recording& recording) {
  const PinholeCamera& camera = recording.rig.camera;
  if (camera.width_px == kKlgWidth_px && camera.height_px == kKlgHeight_px) return {};
  return fail(ErrorCode::usage,
              fmt::format("'{}': images of {}x{} pixels (allowed in .klg: {}x{})", recording.name,
                          camera.width_px, camera.height_px, kKlgWidth_px, kKlgHeight_px),
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
  std::string header;
  append_number(header, static_cast<std::int32_t>(count + 1));
  if (const auto written = put(header); !written) return tl::unexpected(written.error());
  auto counts = for_each_frame(recording, kKlgDepth, [&](const QuantisedFrame& frame) -> Result<void> {
    const std::string bytes = frame_bytes(frame);
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
      calibration, fmt::format("{} {} {} {}\n", camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px));
  if (!calibrated) return tl::unexpected(calibrated.error());
  const auto counts = write_frames(recording, place.file(place.name()));
  if (!counts) return tl::unexpected(counts.error());
  WrittenExport result{*counts, {place.name(), calibration}, {}};
  result.calibration = calibration;
  result.notes = {
      fmt::format("ElasticFusion: ElasticFusion -l {} -cal {} -q; colour is red, green, blue: no -f",
                  place.name(), calibration),
      fmt::format(
          "the file counts {} frames: the last one is written twice, since the reader stops one early",
          recording.frames.size() + 1)};
  if (!recording.imu.empty()) result.notes.push_back("inertial samples are not written");
  return result;
}

KlgReader::KlgReader(LittleEndianReader reader, std::int32_t count, int width_px, int height_px)
    : reader_(std::move(reader)), count_(count), width_px_(width_px), height_px_(height_px) {}

Result<KlgReader> KlgReader::open(const std::filesystem::path& file, int width_px, int height_px) {
  auto reader = LittleEndianReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  const auto count = reader->number<std::int32_t>("the number of frames");
  if (count < 0) reader->complain(fmt::format("{} frames", count));
  if (reader->error()) return tl::unexpected(*reader->error());
  return KlgReader(std::move(*reader), count, width_px, height_px);
}

Result<std::optional<KlgFrame>> KlgReader::next() {
  if (read_ >= count_) return std::nullopt;
  KlgFrame frame;
  frame.timestamp_us = reader_.number<std::int64_t>("the stamp");
  const auto depth_size = reader_.number<std::int32_t>("the size of depth");
  const auto color_size = reader_.number<std::int32_t>("the size of colour");
  if (depth_size < 0 || color_size < 0)
    reader_.complain(fmt::format("frame {}: {} bytes of depth, {} of colour", read_, depth_size, color_size));
  const std::string depth = reader_.bytes(static_cast<std::uint64_t>(std::max(depth_size, 0)), "depth");
  std::string color = reader_.bytes(static_cast<std::uint64_t>(std::max(color_size, 0)), "colour");
  if (reader_.error()) return tl::unexpected(*reader_.error());
  auto plain = plain_depth(depth, width_px_, height_px_);
  auto values = plain ? std::move(plain) : unpacked_depth(depth, width_px_, height_px_);
  if (!values) {
    reader_.complain(
        fmt::format("frame {}: depth is damaged, or not of {}x{} pixels", read_, width_px_, height_px_));
    return tl::unexpected(*reader_.error());
  }
  frame.depth_mm = std::move(*values);
  const std::size_t plain_color = frame.depth_mm.data.size() * sizeof(Rgb);
  if (color.size() == plain_color) {
    frame.color = ColorImage(width_px_, height_px_);
    std::memcpy(frame.color.data.data(), color.data(), color.size());
  } else {
    frame.jpeg = std::move(color);
  }
  ++read_;
  return frame;
}

}  // namespace fusebench::exports
