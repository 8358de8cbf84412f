#include "datasets/calibration/bilinear_map.hpp"

#include <algorithm>
#include <cstring>

#include "core/base/error.hpp"

namespace fusebench::calibration {

namespace {

// Vector types of the compiler: the same bytes with any instruction set.
using Bytes16 [[gnu::vector_size(16)]] = std::uint8_t;
using Shorts16 [[gnu::vector_size(32)]] = std::int16_t;

constexpr std::size_t kAtOnce = sizeof(Bytes16);
constexpr std::size_t kChannels = sizeof(Rgb);

/// As many bytes as they are moved together, widened.
Shorts16 load(const std::uint8_t* from) {
  Bytes16 bytes;
  std::memcpy(&bytes, from, sizeof(bytes));
  return __builtin_convertvector(bytes, Shorts16);
}

/// Where values come from: the upper left neighbour of the first one, and the distances to the others.
struct Neighbours {
  const std::uint8_t* first;
  std::size_t right;
  std::size_t down;
};

/// (32 upper + (lower - upper) y + 512) / 1024, where upper and lower are 32 times too large already. The
/// product needs 18 bits; cut into a multiple of 32 and a rest, it fits into 16.
void blend_16(const Neighbours& from, const std::uint8_t* x_weight, const std::uint8_t* y_weight,
              std::uint8_t* target) {
  const auto mix = [x = load(x_weight)](Shorts16 left, Shorts16 right) {
    return 32 * left + (right - left) * x;
  };
  const Shorts16 upper = mix(load(from.first), load(from.first + from.right));
  const Shorts16 lower = mix(load(from.first + from.down), load(from.first + from.down + from.right));
  const Shorts16 y = load(y_weight);
  const Shorts16 step = lower - upper;
  const Shorts16 rest = ((step & 31) * y + 512) >> 5;
  const Bytes16 values = __builtin_convertvector((upper + (step >> 5) * y + rest) >> 5, Bytes16);
  std::memcpy(target, &values, sizeof(values));
}

/// The same for one value.
std::uint8_t blend(const Neighbours& from, int x, int y) {
  const auto mix = [x](int left, int right) { return 32 * left + (right - left) * x; };
  const int upper = mix(from.first[0], from.first[from.right]);
  const int lower = mix(from.first[from.down], from.first[from.down + from.right]);
  return static_cast<std::uint8_t>((32 * upper + (lower - upper) * y + 512) >> 10);
}

}  // namespace

BilinearMap::BilinearMap(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  check(width_px > 0 && height_px > 0, "a map has a size");
  const auto row = kChannels * static_cast<std::size_t>(width_px);
  // An image of one row or column has no other neighbours than its pixels themselves.
  right_ = width_px > 1 ? kChannels : 0;
  down_ = height_px > 1 ? row : 0;
  x_weight_.reserve(row * static_cast<std::size_t>(height_px));
  y_weight_.reserve(row * static_cast<std::size_t>(height_px));
}

void BilinearMap::add(std::int32_t x, std::int32_t y) {
  // The last neighbours are those before the border, which has all the weight then.
  const auto neighbour = [](std::int32_t at, int size_px) {
    return std::clamp(at / kFractions, 0, std::max(size_px - 2, 0));
  };
  x = std::clamp(x, 0, kFractions * (width_px_ - 1));
  y = std::clamp(y, 0, kFractions * (height_px_ - 1));
  const std::int32_t left = neighbour(x, width_px_);
  const std::int32_t top = neighbour(y, height_px_);
  const std::size_t source =
      kChannels *
      (static_cast<std::size_t>(top) * static_cast<std::size_t>(width_px_) + static_cast<std::size_t>(left));
  const std::size_t target = x_weight_.size();
  if (runs_.empty() || runs_.back().source + runs_.back().count != source)
    runs_.push_back({target, source, 0});
  runs_.back().count += kChannels;
  x_weight_.insert(x_weight_.end(), kChannels, static_cast<std::uint8_t>(x - kFractions * left));
  y_weight_.insert(y_weight_.end(), kChannels, static_cast<std::uint8_t>(y - kFractions * top));
}

ColorImage BilinearMap::apply(const ColorImage& source) const {
  check(source.width == width_px_ && source.height == height_px_, "the image has the size of the map");
  const std::size_t size = kChannels * source.data.size();
  check(size > 0 && x_weight_.size() == size, "the map is complete");
  ColorImage result(source.width, source.height);
  const std::uint8_t* const from = source.data.front().data();
  std::uint8_t* const to = result.data.front().data();
  for (const Run& run : runs_) {
    const auto neighbours = [&](std::size_t i) { return Neighbours{from + run.source + i, right_, down_}; };
    const std::uint8_t* const x = &x_weight_[run.target];
    const std::uint8_t* const y = &y_weight_[run.target];
    std::uint8_t* const target = to + run.target;
    // The last vector of a run reaches into the next one, which is written later. There may be none at the
    // end.
    const std::size_t end = run.count + kAtOnce;
    if (run.source + end + right_ + down_ <= size && run.target + end <= size) {
      for (std::size_t i = 0; i < run.count; i += kAtOnce) blend_16(neighbours(i), x + i, y + i, target + i);
    } else {
      for (std::size_t i = 0; i < run.count; ++i) target[i] = blend(neighbours(i), x[i], y[i]);
    }
  }
  return result;
}

}  // namespace fusebench::calibration
