// An empty room as a scene file, for tests that need any scene: building the furnished one takes a second.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/mesh/ply_file.hpp"

namespace fusebench::testing {

/// Walls of 4 x 3.6 x 2.8 m, seen from inside, with vertices every few decimetres. Returns the file.
inline std::filesystem::path write_box_scene(const std::filesystem::path& folder) {
  constexpr std::uint32_t kCells = 8;
  const Eigen::Vector3f half(2.0F, 1.8F, 1.4F);
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (std::uint32_t i = 0; i <= kCells; ++i) {
        for (std::uint32_t j = 0; j <= kCells; ++j) {
          Eigen::Vector3f unit;
          unit[axis] = side;
          unit[(axis + 1) % 3] = 2 * static_cast<float>(i) / kCells - 1;
          unit[(axis + 2) % 3] = 2 * static_cast<float>(j) / kCells - 1;
          mesh.vertices.push_back(unit.cwiseProduct(half) + Eigen::Vector3f(0, 0, half.z()));
          if (i == kCells || j == kCells) continue;
          const std::uint32_t a = first + i * (kCells + 1) + j;
          const std::uint32_t b = a + kCells + 1;
          mesh.triangles.push_back({a, b, b + 1});
          mesh.triangles.push_back({a, b + 1, a + 1});
        }
      }
    }
  }
  const std::filesystem::path file = folder / "box.ply";
  const auto written = mesh::write_ply(mesh, file);
  EXPECT_TRUE(written);
  return file;
}

}  // namespace fusebench::testing
