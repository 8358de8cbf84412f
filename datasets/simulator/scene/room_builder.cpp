#include "datasets/simulator/scene/room_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fusebench::simulator::scene {

namespace {

constexpr double kCell_m = 0.125;  // cell size of large surfaces; limits the sharpness of shadows
constexpr int kAround = 24;        // facets of round objects
constexpr int kRings = 14;

}  // namespace

std::int32_t RoomBuilder::add_texture(const texture::ReflectanceImage& image) {
  scene_.textures.emplace_back(image);
  return static_cast<std::int32_t>(scene_.textures.size()) - 1;
}

std::uint32_t RoomBuilder::add_vertex(const Vector3d& point, const Vector3d& normal, const Vector2d& texture,
                                      float light) {
  scene_.mesh.vertices.push_back(point.cast<float>());
  scene_.mesh.normals.push_back(normal.cast<float>());
  scene_.texture_coordinates.push_back(texture.cast<float>());
  scene_.light.push_back(light);
  return static_cast<std::uint32_t>(scene_.mesh.vertices.size()) - 1;
}

void RoomBuilder::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::int32_t texture) {
  scene_.mesh.triangles.push_back({a, b, c});
  scene_.triangle_textures.push_back(texture);
}

void RoomBuilder::add_rectangle(const Vector3d& corner, const Vector3d& along, const Vector3d& up,
                                const Paint& paint) {
  const Vector3d normal = along.cross(up).normalized();
  const auto cells = [](double length) { return std::max(1, static_cast<int>(std::ceil(length / kCell_m))); };
  const int columns = cells(along.norm());
  const int rows = cells(up.norm());
  const Vector2d repeats =
      paint.repeat_m > 0 ? Vector2d(Vector2d(along.norm(), up.norm()) / paint.repeat_m) : Vector2d(1, 1);
  const auto first = static_cast<std::uint32_t>(scene_.mesh.vertices.size());
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Vector2d place(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
      add_vertex(corner + place.x() * along + place.y() * up, normal,
                 paint.offset + place.cwiseProduct(repeats), paint.brightness);
    }
  }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      add_triangle(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), paint.texture);
      add_triangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1), paint.texture);
    }
  }
}

void RoomBuilder::add_box(const SE3& T_room_box, const Vector3d& size, const Paint& sides, const Paint& top) {
  const Vector3d x = T_room_box.rotation * Vector3d(size.x(), 0, 0);
  const Vector3d y = T_room_box.rotation * Vector3d(0, size.y(), 0);
  const Vector3d z = T_room_box.rotation * Vector3d(0, 0, size.z());
  const Vector3d corner = T_room_box.translation - 0.5 * x - 0.5 * y;
  const auto shifted = [&](double by) {
    Paint paint = sides;
    paint.offset.x() += by;  // avoids a continuous pattern over the faces
    return paint;
  };
  add_rectangle(corner, x, z, sides);                   // towards -y
  add_rectangle(corner + x, y, z, shifted(0.37));       // towards +x
  add_rectangle(corner + x + y, -x, z, shifted(0.61));  // towards +y
  add_rectangle(corner + y, -y, z, shifted(0.83));      // towards -x
  add_rectangle(corner + z, x, y, top);
  add_rectangle(corner + y, x, -y, sides);  // below
}

void RoomBuilder::add_cap(const SE3& T_room_base, double z, double radius, double sign, const Paint& paint) {
  const double repeat_m = paint.repeat_m > 0 ? paint.repeat_m : 2 * radius;
  const Vector3d normal = T_room_base.rotation * Vector3d(0, 0, sign);
  const std::uint32_t centre =
      add_vertex(T_room_base * Vector3d(0, 0, z), normal, paint.offset, paint.brightness);
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    const Vector2d rim = radius * Vector2d(std::cos(angle), std::sin(angle));
    add_vertex(T_room_base * Vector3d(rim.x(), rim.y(), z), normal, paint.offset + rim / repeat_m,
               paint.brightness);
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t a = centre + 1 + i;
    const std::uint32_t b = centre + 1 + (i + 1) % kAround;
    if (sign > 0) {
      add_triangle(centre, a, b, paint.texture);
    } else {
      add_triangle(centre, b, a, paint.texture);
    }
  }
}

void RoomBuilder::add_frustum(const SE3& T_room_base, double radius_bottom, double radius_top, double height,
                              const Paint& paint) {
  const double around_m = std::numbers::pi * (radius_bottom + radius_top);
  const double repeats_u = paint.repeat_m > 0 ? std::max(1.0, std::round(around_m / paint.repeat_m)) : 1;
  const double repeats_v = paint.repeat_m > 0 ? height / paint.repeat_m : 1;
  const int rows = std::max(1, static_cast<int>(std::ceil(height / kCell_m)));
  const auto first = static_cast<std::uint32_t>(scene_.mesh.vertices.size());
  for (int j = 0; j <= rows; ++j) {
    const double share = static_cast<double>(j) / rows;
    const double radius = radius_bottom + share * (radius_top - radius_bottom);
    for (int i = 0; i <= kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      const Vector3d outward(std::cos(angle), std::sin(angle), (radius_bottom - radius_top) / height);
      const Vector3d point(radius * std::cos(angle), radius * std::sin(angle), share * height);
      const Vector2d texture(repeats_u * i / kAround, repeats_v * share);
      add_vertex(T_room_base * point, T_room_base.rotation * outward.normalized(), paint.offset + texture,
                 paint.brightness);
    }
  }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (kAround + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < kAround; ++i) {
      add_triangle(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), paint.texture);
      add_triangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1), paint.texture);
    }
  }
  add_cap(T_room_base, height, radius_top, 1, paint);
  add_cap(T_room_base, 0, radius_bottom, -1, paint);
}

void RoomBuilder::add_ellipsoid(const SE3& T_room_centre, const Vector3d& radii, const Paint& paint) {
  const double around_m = 2 * std::numbers::pi * std::max(radii.x(), radii.y());
  const double repeats_u = paint.repeat_m > 0 ? std::max(1.0, std::round(around_m / paint.repeat_m)) : 1;
  const double repeats_v = paint.repeat_m > 0 ? 0.5 * around_m / paint.repeat_m : 1;
  const auto first = static_cast<std::uint32_t>(scene_.mesh.vertices.size());
  for (int j = 0; j <= kRings; ++j) {
    const double polar = std::numbers::pi * j / kRings;  // from the lower pole
    for (int i = 0; i <= kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      const Vector3d unit(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                          -std::cos(polar));
      const Vector3d normal = unit.cwiseQuotient(radii).normalized();
      const Vector2d texture(repeats_u * i / kAround, repeats_v * j / kRings);
      add_vertex(T_room_centre * unit.cwiseProduct(radii), T_room_centre.rotation * normal,
                 paint.offset + texture, paint.brightness);
    }
  }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (kAround + 1) + i); };
  for (int j = 0; j < kRings; ++j) {
    for (int i = 0; i < kAround; ++i) {
      if (j > 0) add_triangle(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), paint.texture);
      if (j + 1 < kRings) add_triangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1), paint.texture);
    }
  }
}

}  // namespace fusebench::simulator::scene
