#include "core/base/mesh/obj_file.hpp"

#include <gtest/gtest.h>

#include "core/base/mesh/mesh_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace mesh;

namespace {

class ObjFile : public testing::InTemporaryFolder {};

TEST_F(ObjFile, KeepsEveryDigitOfAVertex) {
  const auto mesh =
      read_mesh(write("QUAD.OBJ",
                      "# a quad\nv 0.123456789012 0 0\n v 1 0 0 \r\nv\t1 1 0\nv 0 1 0\nvn 0 0 1\n"
                      "f 1//1 2//1 3//1 4//1\n"));
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[0].x(), 0.123456789012);
  EXPECT_EQ(mesh->vertices.size(), 4U);
  EXPECT_EQ(mesh->triangles.size(), 2U);
  EXPECT_TRUE(mesh->colors.empty());
}

TEST_F(ObjFile, DoesNotOpenTheMaterialsThatItNames) {
  const auto mesh =
      read_obj(write("mesh.obj", "mtllib /dev/zero\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 1U);
}

TEST_F(ObjFile, NamesWhatIsWrong) {
  const auto refusal = [&](const std::string& text) {
    const auto mesh = read_obj(write("mesh.obj", text));
    return mesh ? "was not refused" : mesh.error().message;
  };
  EXPECT_NE(refusal("v 0 0 0\nv 1 0\n").find("mesh.obj:2: a vertex of 2 numbers"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nv 1 x 0\n").find("mesh.obj:2"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").find("vertex 9 of 3"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 9 4\n").find("vertex 9 of 4"),
            std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nf 1 2 3 9 5\n").find("vertex 9 of 5"),
            std::string::npos);
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  EXPECT_NE(refusal(triangle + "f 1 2 4294967300\n").find("mesh.obj:5: '4294967300' names no vertex"),
            std::string::npos);
  EXPECT_NE(refusal(triangle + "f 1 2x 3\n").find("mesh.obj:5: '2x' names no vertex"), std::string::npos);
  EXPECT_EQ(read_obj(folder_ / "none.obj").error().code, ErrorCode::data_missing);
  const auto other = read_mesh(write("mesh.stl", ""));
  EXPECT_EQ(other.error().code, ErrorCode::usage);
  EXPECT_NE(other.error().message.find(".stl"), std::string::npos);
}

}  // namespace
}  // namespace fusebench
