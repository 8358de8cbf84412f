#include "eval/metrics/intensity_file.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <string_view>
#include <system_error>

namespace fusebench::metrics {

static_assert(std::endian::native == std::endian::little, "the file is written as it lies in memory");

namespace {

constexpr std::string_view kMagic = "FBINTENS";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kFrameMark = 1;
constexpr std::uint32_t kEndMark = 0;

template <class T>
void write(std::ostream& stream, const T& value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

Result<void> IntensityWriter::state() const {
  if (stream_) return {};
  const std::error_code error(errno == 0 ? EIO : errno, std::generic_category());
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", file_.string(), error.message()));
}

Result<IntensityWriter> IntensityWriter::create(const std::filesystem::path& file, int width_px,
                                                int height_px) {
  IntensityWriter writer(file);
  writer.stream_.write(kMagic.data(), static_cast<std::streamsize>(kMagic.size()));
  write(writer.stream_, kVersion);
  write(writer.stream_, static_cast<std::uint32_t>(width_px));
  write(writer.stream_, static_cast<std::uint32_t>(height_px));
  if (auto good = writer.state(); !good) return tl::unexpected(good.error());
  return writer;
}

Result<void> IntensityWriter::write_frame(std::int64_t timestamp_ns,
                                          std::span<const IntensityResidual> pixels) {
  write(stream_, kFrameMark);
  write(stream_, timestamp_ns);
  write(stream_, static_cast<std::uint32_t>(pixels.size()));
  for (const IntensityResidual& pixel : pixels) write(stream_, pixel.pixel);
  for (const IntensityResidual& pixel : pixels) {
    write(stream_, pixel.accepted ? pixel.difference_grey : -pixel.difference_grey);
  }
  ++frames_;
  return state();
}

Result<void> IntensityWriter::finish() {
  write(stream_, kEndMark);
  write(stream_, frames_);
  stream_.close();
  return state();
}

template <class T>
bool IntensityReader::read(T& value) {
  std::array<char, sizeof(T)> bytes{};
  if (bytes_left_ < bytes.size() || !stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    return false;
  bytes_left_ -= bytes.size();
  value = std::bit_cast<T>(bytes);
  return true;
}

template <class T>
bool IntensityReader::read_list(std::vector<T>& values, std::size_t count) {
  // Checked before the memory is requested: a damaged count must not allocate gigabytes.
  if (bytes_left_ < count * sizeof(T)) return false;
  values.resize(count);
  for (T& value : values) {
    if (!read(value)) return false;
  }
  return true;
}

tl::unexpected<Error> IntensityReader::corrupt(const std::string& what) const {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file_.string(), what),
              "repeat the run that wrote it");
}

Result<IntensityReader> IntensityReader::open(const std::filesystem::path& file) {
  IntensityReader reader(file);
  std::error_code error;
  reader.bytes_left_ = std::filesystem::file_size(file, error);
  if (!reader.stream_ || error) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  }
  std::array<char, kMagic.size()> magic{};
  if (!reader.read(magic) || std::string_view(magic.data(), magic.size()) != kMagic) {
    return reader.corrupt("is not a file of intensity differences");
  }
  std::uint32_t version = 0;
  if (!reader.read(version) || version != kVersion) {
    return reader.corrupt(fmt::format("has version {} (this program reads {})", version, kVersion));
  }
  if (!reader.read(reader.width_px_) || !reader.read(reader.height_px_))
    return reader.corrupt("ends in its header");
  return reader;
}

Result<std::optional<IntensityFrame>> IntensityReader::read_end() {
  std::uint64_t count = 0;
  if (!read(count) || count != frames_ || bytes_left_ != 0)
    return corrupt("its end mark does not fit its frames");
  return std::optional<IntensityFrame>{};
}

Result<std::optional<IntensityFrame>> IntensityReader::next() {
  std::uint32_t mark = 0;
  if (!read(mark)) return corrupt(fmt::format("ends early, after frame {}", frames_));
  if (mark == kEndMark) return read_end();
  if (mark != kFrameMark) return corrupt(fmt::format("is damaged after frame {}", frames_));

  IntensityFrame frame;
  std::uint32_t count = 0;
  std::vector<std::uint32_t> keys;
  std::vector<float> differences;
  if (!read(frame.timestamp_ns) || !read(count) || !read_list(keys, count) ||
      !read_list(differences, count)) {
    return corrupt(fmt::format("ends early, in frame {}", frames_));
  }
  const std::uint64_t pixels = std::uint64_t{width_px_} * height_px_;
  frame.pixels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (keys[i] >= pixels || !std::isfinite(differences[i])) {
      return corrupt(fmt::format("frame {} has a value that no run writes", frames_));
    }
    frame.pixels.push_back({keys[i], std::abs(differences[i]), !std::signbit(differences[i])});
  }
  ++frames_;
  return std::optional<IntensityFrame>(std::move(frame));
}

}  // namespace fusebench::metrics
