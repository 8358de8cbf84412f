#include "datasets/recording/sensor_columns.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace fusebench::recording {

namespace {

struct Limit {
  double most;
  std::string_view unit;
  std::string_view hint;
};

constexpr Limit kAngularVelocity{
    kMaxAngularVelocity_radps, "rad/s",
    "no gyroscope measures that: remove the row if it is a fault of the sensor; degrees per second must be "
    "multiplied by 0.0174533"};
constexpr Limit kSpecificForce{
    kMaxSpecificForce_mps2, "m/s^2",
    "no accelerometer of an IMU measures that: remove the row if it is a fault of the sensor, else check the "
    "unit"};
constexpr Limit kPosition{kMaxPosition_m, "m", "remove the row, or subtract an origin from all positions"};
constexpr Limit kVelocity{kMaxVelocity_mps, "m/s", "remove the row, or check the unit"};

Result<Vector3d> read_within(const io::TextTable& table, std::size_t first_column, std::string_view name,
                             const Limit& limit) {
  Vector3d values;
  if (const auto read = table.numbers(first_column, {values.data(), 3}); !read)
    return tl::unexpected(read.error());
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    if (std::abs(value) <= limit.most) continue;
    return table.fail_here(fmt::format("{}{} = {:g} {} (allowed {:g} .. {:g})", name, "xyz"[i], value,
                                       limit.unit, -limit.most, limit.most),
                           std::string(limit.hint));
  }
  return values;
}

}  // namespace

Result<Vector3d> read_angular_velocity(const io::TextTable& table, std::size_t first_column,
                                       std::string_view name) {
  return read_within(table, first_column, name, kAngularVelocity);
}

Result<Vector3d> read_specific_force(const io::TextTable& table, std::size_t first_column,
                                     std::string_view name) {
  return read_within(table, first_column, name, kSpecificForce);
}

Result<Vector3d> read_position(const io::TextTable& table, std::size_t first_column, std::string_view name) {
  return read_within(table, first_column, name, kPosition);
}

Result<Vector3d> read_velocity(const io::TextTable& table, std::size_t first_column, std::string_view name) {
  return read_within(table, first_column, name, kVelocity);
}

}  // namespace fusebench::recording
