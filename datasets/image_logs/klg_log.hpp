// .klg logs of ElasticFusion and Kintinuous (Whelan et al., IJRR 2016). Little-endian:
//
//     int32                frames
//     of each frame        int64 stamp in microseconds, int32 bytes of depth, int32 bytes of colour,
//                          depth: uint16 millimetres, a zlib stream, or plain if there are 2 w h bytes;
//                          colour: a JPEG, or plain RGB if there are 3 w h bytes; 0 bytes: none
//
// The size of the images is not in the file: ElasticFusion takes 640x480.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "datasets/image_logs/little_endian.hpp"

namespace fusebench::image_logs {

inline constexpr int kKlgWidth_px = 640;
inline constexpr int kKlgHeight_px = 480;

struct KlgFrame {
  std::int64_t timestamp_us = 0;
  Image<std::uint16_t> depth_mm;  ///< 0 = no measurement
  ColorImage color;               ///< empty if the frame has none, or a JPEG
  std::string jpeg;               ///< the colour image as it is stored; empty if it is plain
};

/// The bytes at the beginning of a log, and of a frame of it with packed depth and plain colour (jpeg is not
/// written), so that both come back as they are.
[[nodiscard]] std::string klg_header(std::size_t frames);
[[nodiscard]] std::string klg_bytes(const KlgFrame& frame);

/// Reads a log frame by frame, all that are in the file.
class KlgReader {
 public:
  /// Errors: data_missing; data_corrupt (a negative number of frames).
  [[nodiscard]] static Result<KlgReader> open(const std::filesystem::path& file, int width_px = kKlgWidth_px,
                                              int height_px = kKlgHeight_px);

  [[nodiscard]] std::int32_t frame_count() const { return count_; }
  /// Nothing after the last one. Errors: data_corrupt (the file ends early, depth that is damaged or of
  /// another size).
  [[nodiscard]] Result<std::optional<KlgFrame>> next();

 private:
  KlgReader(LittleEndianReader reader, std::int32_t count, int width_px, int height_px);

  LittleEndianReader reader_;
  std::int32_t count_ = 0;
  std::int32_t read_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
};

}  // namespace fusebench::image_logs
