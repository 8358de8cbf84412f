#include "datasets/simulator/rays/ray_caster.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/simulator/random/random_numbers.hpp"

namespace fusebench {

using namespace simulator::random;
using namespace simulator::rays;

namespace {

using Vector3l = Eigen::Matrix<long double, 3, 1>;

struct ReferenceHit {
  long double distance, u, v, cosine;
};

/// Solves origin + t direction = a + u (b - a) + v (c - a) by Cramer's rule.
ReferenceHit reference_hit(const Mesh& triangle, const Eigen::Vector3f& origin,
                           const Eigen::Vector3f& direction) {
  const auto vertex = [&](std::size_t k) { return triangle.vertices[k].cast<long double>().eval(); };
  const Vector3l b = vertex(1) - vertex(0), c = vertex(2) - vertex(0), d = direction.cast<long double>();
  const Vector3l s = origin.cast<long double>() - vertex(0), normal = b.cross(c);
  const long double determinant = -d.dot(normal);
  return {s.dot(normal) / determinant, -d.dot(s.cross(c)) / determinant, -d.dot(b.cross(s)) / determinant,
          std::abs(determinant) / (d.norm() * normal.norm())};
}

Eigen::Vector3f random_point(RandomSequence& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size),
               z = random.uniform(-size, size);
  return Eigen::Vector3d(x, y, z).cast<float>();
}

}  // namespace

// Embree's distances differ in their last bits between the CPUs of two vendors; the correctly rounded number
// does not.
TEST(RayCaster, HitsAreCorrectlyRoundedAndSoTheSameOnEveryCpu) {
  RandomSequence random(11);
  int hit_count = 0;
  for (int i = 0; i < 2000; ++i) {
    Mesh triangle;
    for (int k = 0; k < 3; ++k) triangle.vertices.push_back(random_point(random, 3));
    triangle.triangles.push_back({0, 1, 2});
    const Eigen::Vector3f origin = random_point(random, 1), direction = random_point(random, 1);
    std::array<RayHit, 1> hit;
    RayCaster(triangle).cast(origin, {&direction.x(), 1}, {&direction.y(), 1}, {&direction.z(), 1}, hit);
    const ReferenceHit expected = reference_hit(triangle, origin, direction);
    const long double margin = std::min({expected.u, expected.v, 1 - expected.u - expected.v});
    if (std::abs(margin) < 1e-5L) continue;  // on an edge
    const bool is_hit = margin > 0 && expected.distance > 0;
    ASSERT_EQ(hit[0].triangle, is_hit ? 0 : RayHit::kNothing) << i;
    if (!is_hit) continue;
    ++hit_count;
    EXPECT_EQ(hit[0].distance, static_cast<float>(expected.distance)) << i;
    EXPECT_EQ(hit[0].u, static_cast<float>(expected.u)) << i;
    EXPECT_EQ(hit[0].v, static_cast<float>(expected.v)) << i;
    EXPECT_EQ(hit[0].cos_incidence, static_cast<float>(expected.cosine)) << i;
  }
  EXPECT_GT(hit_count, 100);
}

TEST(RayCaster, EachRayOfAPartlyFilledPacketFindsTheNearestTriangle) {
  Mesh layers;
  for (const float z : {3.0F, 2.0F}) {
    const auto first = static_cast<std::uint32_t>(layers.vertices.size());
    for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {4.0F, -1.0F}, {-1.0F, 4.0F}})
      layers.vertices.emplace_back(x, y, z);
    layers.triangles.push_back({first, first + 1, first + 2});
  }
  constexpr std::size_t kRayCount = 11;
  std::array<float, kRayCount> x{}, y{}, z{};
  for (std::size_t i = 0; i < kRayCount; ++i) {
    x[i] = 0.01F * static_cast<float>(i);
    z[i] = i % 3 == 0 ? -1.0F : 1.0F;
  }
  std::array<RayHit, kRayCount> hits;
  RayCaster(layers).cast(Eigen::Vector3f::Zero(), x, y, z, hits);
  for (std::size_t i = 0; i < kRayCount; ++i) {
    const bool looks_away = i % 3 == 0;
    EXPECT_EQ(hits[i].triangle, looks_away ? RayHit::kNothing : 1) << i;
    EXPECT_EQ(hits[i].distance, looks_away ? 0.0F : 2.0F) << i;
  }
}

}  // namespace fusebench
