#include "core/motion_compensation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/lane_points.hpp"

namespace fusebench {

namespace {

constexpr std::size_t kRowsPerChunk = 32;
/// A border pixel whose motion rounds to hardly more than none is inside.
constexpr float kRounding_px = 1e-4F;
/// Each iteration leaves some hundredths of the error: as much as an image is sheared from row to row.
constexpr int kIterationsFromNothing = 4;
constexpr int kIterationsFromNeighbours = 1;
/// From one row to the next a displacement changes by less, except at an edge of depth.
constexpr float kMostChange_px = 0.5F;

using Bytes [[gnu::vector_size(32)]] = std::uint8_t;  ///< of eight words

/// Eight displacements, pixels.
struct Displacement8 {
  Float8 x{};
  Float8 y{};
};

/// What a displacement is expected to be in the next row: it goes on changing as it did.
class Forecast {
 public:
  [[nodiscard]] Displacement8 next(const Displacement8& now) {
    const Displacement8 change = {now.x - before_.x, now.y - before_.y};
    const Int8 steady = (abs(change.x) < kMostChange_px) & (abs(change.y) < kMostChange_px);
    before_ = now;
    return {steady ? now.x + change.x : now.x, steady ? now.y + change.y : now.y};
  }

 private:
  Displacement8 before_;
};

/// When the rows of an image are exposed, after the frame's instant.
struct RowTimes {
  RowTimes(int rows, double delay_s, double readout_s)
      : first_s(static_cast<float>(delay_s - 0.5 * readout_s)),
        step_s(static_cast<float>(readout_s / (rows - 1))) {}

  [[nodiscard]] float at(float row) const { return first_s + step_s * row; }

  float first_s;
  float step_s;
};

/// A constant velocity of the camera.
struct Motion {
  explicit Motion(const CameraVelocity& velocity)
      : turn(velocity.angular_radps.cast<float>()), linear(velocity.linear_mps.cast<float>()) {}

  [[nodiscard]] Points turned(const Points& a) const {
    return {multiply_add(turn.y(), a.z, -(turn.z() * a.y)), multiply_add(turn.z(), a.x, -(turn.x() * a.z)),
            multiply_add(turn.x(), a.y, -(turn.y() * a.x))};
  }

  /// Rotated by what the camera turns in this time, to the second order. Times are those from one row to the
  /// one that its pixels come from: at 10 rad/s and 100 rows of 54 us the rest is a hundredth of a pixel.
  [[nodiscard]] Points rotated(const Points& a, Float8 time_s) const {
    const Float8 half_squared = 0.5F * time_s * time_s;
    const Points once = turned(a);
    const Points twice = turned(once);
    return {multiply_add(half_squared, twice.x, multiply_add(time_s, once.x, a.x)),
            multiply_add(half_squared, twice.y, multiply_add(time_s, once.y, a.y)),
            multiply_add(half_squared, twice.z, multiply_add(time_s, once.z, a.z))};
  }

  Eigen::Vector3f turn;    // rad/s
  Eigen::Vector3f linear;  // m/s
};

/// What the camera turns by until a row is read, or back from there.
std::vector<Eigen::Matrix3f> row_rotations(const CameraVelocity& velocity, const RowTimes& times, int rows,
                                           double sign) {
  std::vector<Eigen::Matrix3f> rotations;
  rotations.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const auto time_s = static_cast<double>(times.at(static_cast<float>(row)));
    rotations.push_back(so3_exp(sign * time_s * velocity.angular_radps).toRotationMatrix().cast<float>());
  }
  return rotations;
}

/// 1 / depth; 0 where there is no depth, which counts as infinitely far: rotation alone.
Float8 inverse_depth(Float8 depth_m) {
  const Int8 measured = depth_m > 0.0F;
  return measured ? 1.0F / (measured ? depth_m : all_lanes(1.0F)) : Float8{};
}

/// Interpolates one channel of four neighbours, given as bytes of words, and rounds.
struct Bilinear {
  Float8 right;  // shares
  Float8 down;

  [[nodiscard]] Int8 operator()(Int8 upper_left, Int8 upper_right, Int8 lower_left, Int8 lower_right) const {
    const Float8 upper = mixed(upper_left, upper_right);
    const Float8 lower = mixed(lower_left, lower_right);
    return to_int(multiply_add(down, lower - upper, upper + 0.5F));
  }
  [[nodiscard]] Float8 mixed(Int8 a, Int8 b) const {
    const Float8 from = to_float(a);
    return multiply_add(right, to_float(b) - from, from);
  }
};

/// Byte number `at` of each word.
Int8 byte_of(Int8 words, int at) { return (words >> (8 * at)) & 0xFF; }

/// Compensates a tile of an image, row by row: the search for the source of a pixel starts with the
/// displacement of the pixel above it. The columns of a tile do not wait for each other, so that a processor
/// can work on several at once.
class Tile {
 public:
  static constexpr int kMostGroups = 8;  ///< of eight columns

  Tile(const RgbdFrame& source, const PinholeCamera& camera, const SensorTiming& timing,
       const CameraVelocity& velocity, RgbdFrame& target)
      : source_(source),
        target_(target),
        depth_times_(camera.height_px, seconds_between(0, source.depth_offset_ns), timing.depth_readout_s),
        color_times_(camera.height_px, 0.0, timing.color_readout_s),
        motion_(velocity),
        from_row_(row_rotations(velocity, depth_times_, camera.height_px, 1.0)),
        to_row_(row_rotations(velocity, color_times_, camera.height_px, -1.0)),
        fx_(static_cast<float>(camera.fx_px)),
        fy_(static_cast<float>(camera.fy_px)),
        cx_(static_cast<float>(camera.cx_px)),
        cy_(static_cast<float>(camera.cy_px)),
        per_fx_(static_cast<float>(1.0 / camera.fx_px)),
        per_fy_(static_cast<float>(1.0 / camera.fy_px)),
        width_(camera.width_px),
        last_x_(static_cast<float>(camera.width_px - 1)),
        last_y_(static_cast<float>(camera.height_px - 1)) {}

  void compensate(int first_column, int first_row, int end_row) const {
    std::array<Group, kMostGroups> tile;
    std::size_t count = 0;
    for (int x = first_column; x < width_ && count < tile.size(); x += static_cast<int>(kLanes)) {
      // The last group of a row repeats columns of the one before it.
      tile[count++].column = std::min(x, width_ - static_cast<int>(kLanes));
    }
    const std::span<Group> groups = std::span(tile).first(count);
    for (int row = first_row; row < end_row; ++row) {
      const int iterations = row < first_row + 2 ? kIterationsFromNothing : kIterationsFromNeighbours;
      for (int i = 0; i < iterations; ++i) {
        for (Group& group : groups) carry_depth(group, row);
      }
      for (Group& group : groups) keep_inside(group, row);
      for (int i = 0; i < iterations; ++i) {
        for (Group& group : groups) search_color(group, row);
      }
      for (Group& group : groups) {
        write(group, row);
        group.of_depth = group.depth_forecast.next(group.of_depth);
        group.of_color = group.color_forecast.next(group.of_color);
      }
    }
  }

 private:
  [[nodiscard]] Points ray(Float8 u, Float8 v) const {
    return {(u - cx_) * per_fx_, (v - cy_) * per_fy_, all_lanes(1.0F)};
  }

  [[nodiscard]] Int8 is_inside(Float8 x, Float8 y) const {
    return (x >= -kRounding_px) & (x <= last_x_ + kRounding_px) & (y >= -kRounding_px) &
           (y <= last_y_ + kRounding_px);
  }

  /// Displacement from the pixel of a ray to that of where it was carried; none behind the camera. Written as
  /// a difference of rays, so that what stays in place is displaced by exactly nothing.
  [[nodiscard]] Displacement8 between(const Points& ray, const Points& carried) const {
    const Int8 in_front = carried.z > 0.0F;
    const Float8 inverse_z = 1.0F / (in_front ? carried.z : all_lanes(1.0F));
    return {in_front ? fx_ * multiply_add(carried.x, inverse_z, -ray.x) : Float8{},
            in_front ? fy_ * multiply_add(carried.y, inverse_z, -ray.y) : Float8{}};
  }

  /// Eight pixels of a row.
  struct Group {
    [[nodiscard]] Float8 u() const { return static_cast<float>(column) + kLaneNumber; }

    int column = 0;          ///< of the first
    Displacement8 of_depth;  ///< to its source
    Displacement8 of_color;
    Forecast depth_forecast;
    Forecast color_forecast;
    Float8 depth_m{};
    Float8 inverse_depth{};
  };

  /// One iteration: the depth at pixels, from the depth pixels that their own motion carries there.
  void carry_depth(Group& group, int row) const {
    const auto v = static_cast<float>(row);
    const Float8 from_x = group.u() + group.of_depth.x;
    const Float8 from_y = v + group.of_depth.y;
    const Int8 x = to_int(clamp(from_x, 0.0F, last_x_) + 0.5F);
    const Int8 y = to_int(clamp(from_y, 0.0F, last_y_) + 0.5F);
    const Float8 measured_m = gather(source_.depth_m.data.data(), y * width_ + x);
    const Float8 later_s = depth_times_.step_s * (to_float(y) - v);
    const Float8 shift = (depth_times_.at(v) + later_s) * inverse_depth(measured_m);
    const Points from = ray(from_x, from_y);
    const Points turned = motion_.rotated(rotated(from_row_[static_cast<std::size_t>(row)], from), later_s);
    const Points carried = shifted(turned, shift, motion_.linear);
    const Displacement8 forth = between(from, carried);
    group.of_depth = {-forth.x, -forth.y};
    group.depth_m = measured_m > 0.0F ? measured_m * carried.z : Float8{};
  }

  /// No depth from outside.
  void keep_inside(Group& group, int row) const {
    const auto v = static_cast<float>(row);
    const Int8 inside = is_inside(group.u() + group.of_depth.x, v + group.of_depth.y);
    group.of_depth.x = inside ? group.of_depth.x : Float8{};
    group.of_depth.y = inside ? group.of_depth.y : Float8{};
    group.depth_m = inside & (group.depth_m > 0.0F) ? group.depth_m : Float8{};
    group.inverse_depth = inverse_depth(group.depth_m);
  }

  /// One iteration from pixels to where the points behind them were when their rows were read, which depends
  /// on the row where they land.
  void search_color(Group& group, int row) const {
    const auto v = static_cast<float>(row);
    const Points now = ray(group.u(), all_lanes(v));
    const Float8 later_s = color_times_.step_s * (clamp(v + group.of_color.y, 0.0F, last_y_) - v);
    const Float8 shift = -(color_times_.at(v) + later_s) * group.inverse_depth;
    const Points back = shifted(now, shift, motion_.linear);
    group.of_color =
        between(now, motion_.rotated(rotated(to_row_[static_cast<std::size_t>(row)], back), -later_s));
  }

  /// Moved by so much of a vector.
  static Points shifted(const Points& point, Float8 share, const Eigen::Vector3f& by) {
    return {multiply_add(share, all_lanes(by.x()), point.x), multiply_add(share, all_lanes(by.y()), point.y),
            multiply_add(share, all_lanes(by.z()), point.z)};
  }

  void write(const Group& group, int row) const {
    const Float8 x = group.u() + group.of_color.x;
    const Float8 y = static_cast<float>(row) + group.of_color.y;
    const std::size_t pixel = target_.depth_m.index(group.column, row);
    // No colour, no use.
    store(is_inside(x, y) ? group.depth_m : Float8{}, &target_.depth_m.data[pixel]);
    sample(clamp(x, 0.0F, last_x_), clamp(y, 0.0F, last_y_), pixel);
  }

  /// Writes grey and colour of eight pixels, whose sources are at (x, y) inside the image.
  void sample(Float8 x, Float8 y, std::size_t pixel) const {
    const Int8 left = to_int(min(x, all_lanes(last_x_ - 1.0F)));
    const Int8 top = to_int(min(y, all_lanes(last_y_ - 1.0F)));
    const Bilinear mix{x - to_float(left), y - to_float(top)};
    const Int8 upper = top * width_ + left;
    write_grey(mix, upper, pixel);
    if (!source_.color.empty()) write_color(mix, upper, pixel);
  }

  void write_grey(const Bilinear& mix, Int8 upper, std::size_t pixel) const {
    const auto* const bytes = source_.grey.data.data();
    const Int8 above = gather_bytes(bytes, source_.grey.data.size(), upper);
    const Int8 below = gather_bytes(bytes, source_.grey.data.size(), upper + width_);
    const Int8 grey = mix(byte_of(above, 0), byte_of(above, 1), byte_of(below, 0), byte_of(below, 1));
    const Bytes levels = __builtin_shuffle(std::bit_cast<Bytes>(grey),
                                           Bytes{0, 4, 8, 12, 16, 20, 24, 28, 0, 0, 0, 0, 0, 0, 0, 0,
                                                 0, 0, 0, 0,  0,  0,  0,  0,  0, 0, 0, 0, 0, 0, 0, 0});
    std::memcpy(&target_.grey.data[pixel], &levels, kLanes);
  }

  void write_color(const Bilinear& mix, Int8 upper, std::size_t pixel) const {
    static_assert(sizeof(Rgb) == 3 && std::endian::native == std::endian::little);
    const auto* const bytes = source_.color.data.data()->data();
    const auto pixels = [&](Int8 at) { return gather_bytes(bytes, 3 * source_.color.data.size(), 3 * at); };
    const Int8 upper_left = pixels(upper);
    const Int8 upper_right = pixels(upper + 1);
    const Int8 lower_left = pixels(upper + width_);
    const Int8 lower_right = pixels(upper + width_ + 1);
    const auto channel = [&](int at) {
      return mix(byte_of(upper_left, at), byte_of(upper_right, at), byte_of(lower_left, at),
                 byte_of(lower_right, at));
    };
    const Int8 words = channel(0) | channel(1) << 8 | channel(2) << 16;
    const Bytes eight = __builtin_shuffle(
        std::bit_cast<Bytes>(words), Bytes{0,  1,  2,  4,  5,  6,  8,  9,  10, 12, 13, 14, 16, 17, 18, 20,
                                           21, 22, 24, 25, 26, 28, 29, 30, 0,  0,  0,  0,  0,  0,  0,  0});
    std::memcpy(target_.color.data.data() + pixel, &eight, 3 * kLanes);
  }

  const RgbdFrame& source_;
  RgbdFrame& target_;
  RowTimes depth_times_;
  RowTimes color_times_;
  Motion motion_;
  std::vector<Eigen::Matrix3f> from_row_;  // the camera's turn until a depth row is read
  std::vector<Eigen::Matrix3f> to_row_;    // and back from when a colour row is read
  float fx_, fy_, cx_, cy_;                // pixels
  float per_fx_, per_fy_;
  int width_;
  float last_x_, last_y_;
};

}  // namespace

bool needs_compensation(const RgbdFrame& frame, const SensorTiming& timing) {
  return timing.color_readout_s != 0 || timing.depth_readout_s != 0 || frame.depth_offset_ns != 0;
}

void compensate_motion(const RgbdFrame& frame, const PinholeCamera& camera, const SensorTiming& timing,
                       const CameraVelocity& velocity, const Workers& workers, RgbdFrame& result) {
  check(camera.width_px >= static_cast<int>(kLanes) && camera.height_px >= 2,
        "an image has at least 8 columns and 2 rows");
  result.timestamp_ns = frame.timestamp_ns;
  result.capture_offset_ns = frame.capture_offset_ns;
  result.depth_offset_ns = 0;
  result.grey.resize(camera.width_px, camera.height_px);
  result.depth_m.resize(camera.width_px, camera.height_px);
  if (frame.color.empty()) result.color.resize(0, 0);
  if (!frame.color.empty()) result.color.resize(camera.width_px, camera.height_px);
  const Tile tile(frame, camera, timing, velocity, result);
  constexpr int kTileWidth = Tile::kMostGroups * static_cast<int>(kLanes);
  workers.for_chunks(static_cast<std::size_t>(camera.height_px), kRowsPerChunk,
                     [&](std::size_t begin, std::size_t end) {
                       for (int x = 0; x < camera.width_px; x += kTileWidth) {
                         tile.compensate(x, static_cast<int>(begin), static_cast<int>(end));
                       }
                     });
}

}  // namespace fusebench
