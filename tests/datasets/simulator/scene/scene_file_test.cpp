#include "datasets/simulator/scene/scene_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/mesh/ply_file.hpp"
#include "datasets/simulator/render/renderer.hpp"
#include "tests/datasets/simulator/simple_scenes.hpp"

namespace fusebench {

using namespace mesh;
using namespace simulator::scene;
using namespace simulator::render;

namespace {

namespace fs = std::filesystem;

class SceneFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("fusebench_scene_file_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  void expect_error(const fs::path& file, ErrorCode code, const std::string& part,
                    const SceneFileOptions& options = {}) const {
    const auto scene = read_scene(file, options);
    ASSERT_FALSE(scene) << part;
    EXPECT_EQ(scene.error().code, code) << scene.error().message;
    EXPECT_NE(scene.error().message.find(part), std::string::npos) << scene.error().message;
  }

  fs::path folder_;
};

const std::string kQuad = "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\nf 1 2 3 4\n";

TEST_F(SceneFile, KeepsVertexColoursOfPly) {
  const SimulatedScene plane = testing::plane_at(2, 77);
  ASSERT_TRUE(write_ply(plane.mesh, folder_ / "plane.ply"));
  const auto scene = read_scene(folder_ / "plane.ply");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->mesh.vertices, plane.mesh.vertices);
  EXPECT_EQ(scene->mesh.triangles, plane.mesh.triangles);
  EXPECT_EQ(scene->mesh.colors, plane.mesh.colors);
  EXPECT_TRUE(scene->triangle_textures.empty());
}

TEST_F(SceneFile, ReadsObjWithColoursAndPolygons) {
  const auto scene =
      read_scene(write("quad.obj",
                       "# made by hand\nv 0 0 1 1 0 0\nv 2 0 1 0 1 0\nv 2 1 1 0 0 1\nv 0 1 1 0.5 0.5 0.5\n"
                       "f 1 2 3 4\n"));
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->mesh.vertices.size(), 4U);
  EXPECT_EQ(scene->mesh.triangles.size(), 2U);
  EXPECT_EQ(scene->mesh.colors[1], (Rgb{0, 255, 0}));
  EXPECT_EQ(scene->mesh.colors[3], (Rgb{128, 128, 128}));
}

TEST_F(SceneFile, GivesATextureToWhatHasNoColours) {
  const auto scene = read_scene(write("quad.OBJ", kQuad));
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->triangle_textures, (std::vector<std::int32_t>{0, 0}));
  EXPECT_EQ(scene->mesh.vertices.size(), 6U);
  Image<Eigen::Vector3f> light;
  Renderer(*scene).render_light({100, 50, 50.0, 50.0, -0.5, -0.5}, {{SE3{}}}, Vector2d::Zero(), Workers(1),
                                light);
  float least = 1, most = 0;
  for (const Eigen::Vector3f& pixel : light.data) {
    least = std::min(least, pixel.x());
    most = std::max(most, pixel.x());
  }
  EXPECT_GT(least, 0.01F);
  EXPECT_GT(most, 2 * least);
}

TEST_F(SceneFile, TurnsAndScales) {
  const auto scene = read_scene(write("quad.obj", kQuad), {.y_up = true, .metres_per_unit = 0.5});
  ASSERT_TRUE(scene) << scene.error().message;
  // (2, 1, 1) -> (1, 0.5, 0.5) -> (1, -0.5, 0.5)
  EXPECT_TRUE(scene->look_at.isApprox(Eigen::AlignedBox3d(Vector3d(0, -0.5, 0), Vector3d(1, -0.5, 0.5))));
}

TEST_F(SceneFile, NamesWhatIsWrong) {
  expect_error(folder_ / "none.ply", ErrorCode::data_missing, "none.ply");
  expect_error(folder_ / "none.obj", ErrorCode::data_missing, "none.obj");
  expect_error(write("room.stl", ""), ErrorCode::usage, "allowed .ply, .obj");
  expect_error(write("cloud.obj", "v 0 0 0\nv 1 0 0\n"), ErrorCode::data_corrupt, "no triangles");
  expect_error(write("empty.obj", ""), ErrorCode::data_corrupt, "empty.obj");
  expect_error(write("far.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n"), ErrorCode::data_corrupt, "far.obj");
  expect_error(write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ErrorCode::data_corrupt,
               "nan.obj");
  expect_error(write("quad.obj", kQuad), ErrorCode::configuration, "metres_per_unit = 0",
               {.metres_per_unit = 0});
  expect_error(write("quad.obj", kQuad), ErrorCode::configuration, "allowed 1e-6 .. 1e6",
               {.metres_per_unit = 1e300});
  // Finite in the file, infinite in metres.
  expect_error(write("wide.obj", "v 0 0 0\nv 1e37 0 0\nv 0 1 0\nf 1 2 3\n"), ErrorCode::data_corrupt,
               "wide.obj", {.metres_per_unit = 1000});
}

}  // namespace
}  // namespace fusebench
