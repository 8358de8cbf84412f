#include "datasets/image_logs/klg_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "datasets/image_logs/zlib_bytes.hpp"

namespace fusebench::image_logs {

std::string klg_header(std::size_t frames) {
  std::string bytes;
  append_number(bytes, static_cast<std::int32_t>(frames));
  return bytes;
}

std::string klg_bytes(const KlgFrame& frame) {
  const std::size_t plain_size = frame.depth_mm.data.size() * sizeof(std::uint16_t);
  std::string depth = packed_depth(frame.depth_mm);
  // A stream of just that length would be taken for plain values.
  if (depth.size() == plain_size)
    depth.assign(reinterpret_cast<const char*>(frame.depth_mm.data.data()), plain_size);
  const std::size_t color_size = frame.color.data.size() * sizeof(Rgb);
  std::string bytes;
  append_number(bytes, frame.timestamp_us);
  append_number(bytes, static_cast<std::int32_t>(depth.size()));
  append_number(bytes, static_cast<std::int32_t>(color_size));
  bytes += depth;
  bytes.append(reinterpret_cast<const char*>(frame.color.data.data()), color_size);
  return bytes;
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

}  // namespace fusebench::image_logs
