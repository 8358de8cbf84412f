#include "eval/report/model_view.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include "eval/page/figures.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace report;

namespace {

PinholeCamera camera() {
  PinholeCamera camera;
  camera.width_px = camera.height_px = 21;
  camera.fx_px = camera.fy_px = 20;
  camera.cx_px = camera.cy_px = 10;
  return camera;
}

/// A square of one colour across the axis at this depth, that faces the camera at the origin or looks away.
void add_square(Mesh& mesh, float z_m, bool faces, Rgb color) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::pair{-5.0F, -5.0F}, {5.0F, -5.0F}, {5.0F, 5.0F}, {-5.0F, 5.0F}}) {
    mesh.vertices.emplace_back(x, y, z_m);
    mesh.colors.push_back(color);
  }
  // Counter-clockwise seen from outside: with y down, that is from the far side.
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (faces) std::swap(b, c);
    mesh.triangles.push_back({first + a, first + b, first + c});
  };
  add(0, 1, 2);
  add(0, 2, 3);
}

TEST(ModelView, WhatFacesTheCameraIsSeenWithItsColour) {
  Mesh mesh;
  add_square(mesh, 3, true, {200, 100, 50});
  const ColorImage image = model_view(mesh, camera(), SE3{});
  // Straight on, nothing is shaded.
  EXPECT_EQ(image(10, 10), (Rgb{200, 100, 50}));
}

TEST(ModelView, WallsThatFaceAwayAreLookedThrough) {
  Mesh mesh;
  add_square(mesh, 1, false, {255, 0, 0});
  add_square(mesh, 2, false, {0, 255, 0});
  add_square(mesh, 3, true, {0, 0, 200});
  EXPECT_EQ(model_view(mesh, camera(), SE3{})(10, 10), (Rgb{0, 0, 200}));
  // From the other side it is the second that is nearest and faces.
  const SE3 behind{so3_exp({0, std::numbers::pi, 0}), {0, 0, 6}};
  EXPECT_EQ(model_view(mesh, camera(), behind)(10, 10), (Rgb{0, 255, 0}));
}

TEST(ModelView, ShowsLightGreyWhereThereIsNothing) {
  constexpr Rgb kNothing{227, 232, 236};
  EXPECT_EQ(model_view(Mesh{}, camera(), SE3{})(10, 10), kNothing);
  Mesh mesh;
  add_square(mesh, -3, true, {200, 100, 50});
  EXPECT_EQ(model_view(mesh, camera(), SE3{})(10, 10), kNothing) << "it is behind the camera";
}

TEST(PanelFigure, HasAPlaceForEachImage) {
  const std::string script = page::panels_script({{"a \"b\"", "1.png"}, {"c", "2.png"}, {"d", "3.png"}}, 2,
                                                 {100, 80}, "f.svg", page::FigureFormat::svg);
  testing::expect_contains(script, "set multiplot layout 2,2");
  testing::expect_contains(script, "set title \"a \\\"b\\\"\"");
  testing::expect_contains(script, "plot \"3.png\" binary filetype=png with rgbimage");
}

}  // namespace
}  // namespace fusebench
