#include "datasets/recording/image_logs/zlib_bytes.hpp"

#include <zlib.h>

#include <bit>
#include <cstring>

#include "core/base/error.hpp"

namespace fusebench::image_logs {

namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

std::size_t depth_bytes(int width_px, int height_px) {
  return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * sizeof(std::uint16_t);
}

std::size_t bytes_of(const Image<std::uint16_t>& depth) { return depth_bytes(depth.width, depth.height); }

}  // namespace

std::string packed_depth(const Image<std::uint16_t>& depth) {
  const uLong size = bytes_of(depth);
  uLongf packed_size = compressBound(size);
  std::string packed(packed_size, '\0');
  const int done = compress(reinterpret_cast<Bytef*>(packed.data()), &packed_size,
                            reinterpret_cast<const Bytef*>(depth.data.data()), size);
  check(done == Z_OK, "the buffer is as large as zlib asks for");
  packed.resize(packed_size);
  return packed;
}

std::optional<Image<std::uint16_t>> unpacked_depth(std::string_view packed, int width_px, int height_px) {
  // A file may claim any size, but one byte makes at most 1032.
  constexpr std::size_t kMostPerByte = 1032;
  uLongf size = depth_bytes(width_px, height_px);
  if (size / kMostPerByte > packed.size()) return std::nullopt;
  Image<std::uint16_t> depth(width_px, height_px);
  const int done = uncompress(reinterpret_cast<Bytef*>(depth.data.data()), &size,
                              reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (done != Z_OK || size != bytes_of(depth)) return std::nullopt;
  return depth;
}

std::optional<Image<std::uint16_t>> plain_depth(std::string_view values, int width_px, int height_px) {
  if (values.size() != depth_bytes(width_px, height_px)) return std::nullopt;
  Image<std::uint16_t> depth(width_px, height_px);
  std::memcpy(depth.data.data(), values.data(), values.size());
  return depth;
}

}  // namespace fusebench::image_logs
