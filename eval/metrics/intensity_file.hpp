// The intensity differences of a run, frame by frame, in a small binary file: what the common-pixel AIE
// reads.
//
// Little-endian. Header: 8 bytes "FBINTENS", u32 version (2), u32 width_px, u32 height_px. Each frame: u32 1,
// i64 timestamp_ns, u32 count, then count u32 (pixel of this frame, v * width + u), then count f32
// (absolute difference in grey levels; the sign bit is set if the patch did not pass the gate). End: u32 0,
// u64 number of frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/intensity_residual.hpp"
#include "core/base/io/input_file.hpp"

namespace fusebench::metrics {

class IntensityWriter {
 public:
  /// Error io if the file cannot be created.
  [[nodiscard]] static Result<IntensityWriter> create(const std::filesystem::path& file, int width_px,
                                                      int height_px);

  [[nodiscard]] Result<void> write_frame(std::int64_t timestamp_ns,
                                         std::span<const IntensityResidual> pixels);
  /// Writes the end mark; a file without it is read as truncated.
  [[nodiscard]] Result<void> finish();

 private:
  explicit IntensityWriter(const std::filesystem::path& file)
      : file_(file), stream_(file, std::ios::binary) {}
  [[nodiscard]] Result<void> state() const;

  std::filesystem::path file_;
  std::ofstream stream_;
  std::uint64_t frames_ = 0;
};

struct IntensityFrame {
  std::int64_t timestamp_ns = 0;
  std::vector<IntensityResidual> pixels;
};

class IntensityReader {
 public:
  /// Errors: data_missing, or data_corrupt for a wrong magic or version.
  [[nodiscard]] static Result<IntensityReader> open(const std::filesystem::path& file);

  /// The next frame, or nullopt after the last. Error data_corrupt for a file that ends early, has a wrong
  /// mark, or a pixel outside the image.
  [[nodiscard]] Result<std::optional<IntensityFrame>> next();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::uint32_t width_px() const { return width_px_; }
  [[nodiscard]] std::uint32_t height_px() const { return height_px_; }

 private:
  explicit IntensityReader(const std::filesystem::path& file) : file_(file), stream_(io::input_file(file)) {}
  [[nodiscard]] tl::unexpected<Error> corrupt(const std::string& what) const;
  [[nodiscard]] Result<std::optional<IntensityFrame>> read_end();

  std::filesystem::path file_;
  std::ifstream stream_;
  std::uint64_t bytes_left_ = 0;
  std::uint64_t frames_ = 0;
  std::uint32_t width_px_ = 0;
  std::uint32_t height_px_ = 0;

  template <class T>
  bool read(T& value);
  template <class T>
  bool read_list(std::vector<T>& values, std::size_t count);
};

}  // namespace fusebench::metrics
