#include "core/motion_compensation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fusebench {

namespace {

constexpr std::size_t kRowsPerChunk = 16;
/// Back-projection and projection round: without this a border pixel that did not move could count as
/// outside.
constexpr double kRounding_px = 1e-6;

/// Camera motion between the instant of each row and that of the frame: X_frame = R X_row + t.
struct RowMotion {
  Matrix3d R_frame_row;
  Vector3d t_frame_row_m;
};

std::vector<RowMotion> row_motions(int rows, double delay_s, double readout_s,
                                   const CameraVelocity& velocity) {
  std::vector<RowMotion> motions(static_cast<std::size_t>(rows));
  for (int v = 0; v < rows; ++v) {
    const double after_s = delay_s + (static_cast<double>(v) / (rows - 1) - 0.5) * readout_s;
    motions[static_cast<std::size_t>(v)] = {so3_exp(after_s * velocity.angular_radps).toRotationMatrix(),
                                            after_s * velocity.linear_mps};
  }
  return motions;
}

bool is_inside(const Vector2d& pixel_px, const PinholeCamera& camera) {
  return pixel_px.x() >= -kRounding_px && pixel_px.x() <= camera.width_px - 1 + kRounding_px &&
         pixel_px.y() >= -kRounding_px && pixel_px.y() <= camera.height_px - 1 + kRounding_px;
}

/// std::lround for numbers from 0 on; that one is a call, eleven times a pixel.
int rounded(double value) {
  const int floored = static_cast<int>(value);
  return value - floored >= 0.5 ? floored + 1 : floored;  // the difference is exact
}

int nearest_index(double coordinate, int size) { return rounded(std::clamp(coordinate, 0.0, size - 1.0)); }

/// Neighbouring pixels come from neighbouring sources: each search starts with the displacement of the pixel
/// before it in the row, and only the first of a row starts from nothing.
int search_iterations(int u) { return u == 0 ? 8 : 2; }

/// Fixed point for each pixel of a row: the source is the depth pixel that its own motion carries onto the
/// pixel.
void compensate_depth_row(const DepthImage& source_m, const PinholeCamera& camera,
                          const std::vector<RowMotion>& motions, int v, DepthImage& target_m) {
  Vector2d displacement = Vector2d::Zero();
  for (int u = 0; u < camera.width_px; ++u) {
    const Vector2d wanted(u, v);
    double carried_m = 0;
    for (int iteration = 0; iteration < search_iterations(u); ++iteration) {
      const Vector2d from = wanted + displacement;
      const int x = nearest_index(from.x(), camera.width_px);
      const int y = nearest_index(from.y(), camera.height_px);
      const RowMotion& motion = motions[static_cast<std::size_t>(y)];
      const double measured_m = source_m(x, y);
      const Vector3d ray = camera.back_project(from.x(), from.y(), 1.0);
      // Without a measurement the point counts as far away: rotation alone.
      const Vector3d carried = measured_m > 0
                                   ? Vector3d(motion.R_frame_row * (measured_m * ray) + motion.t_frame_row_m)
                                   : Vector3d(motion.R_frame_row * ray);
      if (carried.z() <= 0) break;
      carried_m = measured_m > 0 ? carried.z() : 0.0;
      displacement += wanted - camera.project(carried);
    }
    const bool inside = is_inside(wanted + displacement, camera);
    target_m(u, v) = inside ? static_cast<float>(carried_m) : 0.0F;
    if (!inside) displacement.setZero();
  }
}

/// Where the point behind a pixel was when its row was read: found by repeating with the row that it lands
/// in.
std::optional<Vector2d> color_source(const PinholeCamera& camera, const std::vector<RowMotion>& motions,
                                     int u, int v, double depth_m) {
  const Vector3d ray = camera.back_project(u, v, 1.0);
  double row = v;
  Vector2d source(u, v);
  for (int iteration = 0; iteration < 3; ++iteration) {
    const RowMotion& motion = motions[static_cast<std::size_t>(nearest_index(row, camera.height_px))];
    const Vector3d then =
        depth_m > 0 ? Vector3d(motion.R_frame_row.transpose() * (depth_m * ray - motion.t_frame_row_m))
                    : Vector3d(motion.R_frame_row.transpose() * ray);
    if (then.z() <= 0) return std::nullopt;
    source = camera.project(then);
    row = source.y();
  }
  return source;
}

Rgb sample_color(const ColorImage& image, double x, double y) {
  const int x0 = std::clamp(static_cast<int>(x), 0, image.width - 2);
  const int y0 = std::clamp(static_cast<int>(y), 0, image.height - 2);
  const double ax = x - x0;
  const double ay = y - y0;
  Rgb result{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double upper = (1 - ax) * image(x0, y0)[c] + ax * image(x0 + 1, y0)[c];
    const double lower = (1 - ax) * image(x0, y0 + 1)[c] + ax * image(x0 + 1, y0 + 1)[c];
    result[c] = static_cast<std::uint8_t>(rounded((1 - ay) * upper + ay * lower));
  }
  return result;
}

void compensate_color_row(const RgbdFrame& source, const PinholeCamera& camera,
                          const std::vector<RowMotion>& motions, int v, RgbdFrame& target) {
  for (int u = 0; u < camera.width_px; ++u) {
    const Vector2d from = color_source(camera, motions, u, v, target.depth_m(u, v)).value_or(Vector2d(u, v));
    const double x = std::clamp(from.x(), 0.0, camera.width_px - 1.0);
    const double y = std::clamp(from.y(), 0.0, camera.height_px - 1.0);
    target.grey(u, v) = static_cast<std::uint8_t>(rounded(sample_bilinear(source.grey, x, y).value));
    target.color(u, v) = sample_color(source.color, x, y);
    if (!is_inside(from, camera)) target.depth_m(u, v) = 0;  // no colour, no use
  }
}

}  // namespace

bool needs_compensation(const RgbdFrame& frame, const SensorTiming& timing) {
  return timing.color_readout_s != 0 || timing.depth_readout_s != 0 || frame.depth_offset_ns != 0;
}

RgbdFrame compensate_motion(const RgbdFrame& frame, const PinholeCamera& camera, const SensorTiming& timing,
                            const CameraVelocity& velocity, const Workers& workers) {
  RgbdFrame result = frame;
  result.depth_offset_ns = 0;
  const auto depth_motions = row_motions(camera.height_px, seconds_between(0, frame.depth_offset_ns),
                                         timing.depth_readout_s, velocity);
  const auto color_motions = row_motions(camera.height_px, 0.0, timing.color_readout_s, velocity);
  workers.for_chunks(static_cast<std::size_t>(camera.height_px), kRowsPerChunk,
                     [&](std::size_t begin, std::size_t end) {
                       for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
                         compensate_depth_row(frame.depth_m, camera, depth_motions, v, result.depth_m);
                         compensate_color_row(frame, camera, color_motions, v, result);
                       }
                     });
  return result;
}

}  // namespace fusebench
