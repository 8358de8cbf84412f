// Meshes whose distances are known, or are to be found out the slow way.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "core/base/types.hpp"

namespace fusebench::testing {

inline Vector3d random_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

/// Triangles of all sizes, among them slivers, needles and points.
inline PreciseMesh triangle_soup(std::size_t count) {
  std::mt19937_64 random(3);
  PreciseMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d a = random_point(random, 1);
    Vector3d b = a + random_point(random, i % 3 == 0 ? 0.5 : 0.05);
    Vector3d c = a + random_point(random, 0.1);
    if (i % 10 == 1) c = a + 0.3 * (b - a) + random_point(random, 1e-5);  // a sliver
    if (i % 10 == 2) c = a + 0.25 * (b - a);                              // no area
    if (i % 10 == 3) b = a;                                               // a line
    if (i % 50 == 4) b = c = a;                                           // a point
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// A sphere of triangles whose corners lie on it.
inline PreciseMesh sphere(double radius_m, int rings) {
  PreciseMesh mesh;
  const int sides = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      const double polar = M_PI * i / rings;
      const double turn = 2 * M_PI * j / sides;
      mesh.vertices.push_back(radius_m * Vector3d(std::sin(polar) * std::cos(turn),
                                                  std::sin(polar) * std::sin(turn), std::cos(polar)));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sides; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace fusebench::testing
