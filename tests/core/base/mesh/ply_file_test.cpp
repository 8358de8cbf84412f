#include "core/base/mesh/ply_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace fusebench {

using namespace mesh;

namespace {

namespace fs = std::filesystem;

class PlyFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("fusebench_ply_file_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path write(const std::string& bytes) const {
    const fs::path file = folder_ / "mesh.ply";
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  [[nodiscard]] static std::string bytes_of(const fs::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  }
  // Reads text that must be refused as corrupt, with this in the message.
  void expect_corrupt(const std::string& bytes, const std::string& part) const {
    const auto mesh = read_ply(write(bytes));
    ASSERT_FALSE(mesh) << part;
    EXPECT_EQ(mesh.error().code, ErrorCode::data_corrupt);
    EXPECT_NE(mesh.error().message.find(part), std::string::npos) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find("mesh.ply:"), std::string::npos) << mesh.error().message;
  }

  fs::path folder_;
};

Mesh tetrahedron() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1.5F, 0, 1e-20F}, {0, -2.25F, 0}, {0.1F, 0.2F, 0.3F}};
  mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6F, 0.8F, 0}};
  mesh.colors = {{0, 1, 2}, {255, 254, 253}, {10, 13, 26}, {128, 0, 64}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.triangles, b.triangles);
}

const std::string kAsciiHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(PlyFile, RoundTripsWithAndWithoutNormalsAndColours) {
  for (const bool normals : {true, false}) {
    for (const bool colors : {true, false}) {
      Mesh mesh = tetrahedron();
      if (!normals) mesh.normals.clear();
      if (!colors) mesh.colors.clear();
      ASSERT_TRUE(write_ply(mesh, folder_ / "mesh.ply"));
      const auto read = read_ply(folder_ / "mesh.ply");
      ASSERT_TRUE(read) << read.error().message;
      expect_same(read->cast<float>(), mesh);
    }
  }
  Mesh measured = tetrahedron();
  measured.quality = {0, 0.5F, 1e-6F, 3};
  ASSERT_TRUE(write_ply(measured, folder_ / "measured.ply"));
  EXPECT_EQ(read_ply(folder_ / "measured.ply")->quality, measured.quality);
  Mesh surfels = tetrahedron();
  surfels.triangles.clear();
  surfels.radii_m = {0.01F, 0.02F, 0.03F, 0.04F};
  ASSERT_TRUE(write_ply(surfels, folder_ / "surfels.ply"));
  EXPECT_EQ(read_ply(folder_ / "surfels.ply")->radii_m, surfels.radii_m);
  ASSERT_TRUE(write_ply(Mesh{}, folder_ / "empty.ply"));
  const auto empty = read_ply(folder_ / "empty.ply");
  ASSERT_TRUE(empty) << empty.error().message;
  expect_same(empty->cast<float>(), Mesh{});
}

TEST_F(PlyFile, RadiiAreOfSurfels) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float radius\n";
  EXPECT_EQ(read_ply(write(header + "end_header\n0 0 0 0 0 1 0.5\n"))->radii_m, std::vector<float>{0.5F});
  for (const std::string radius : {"0", "-1", "nan", "inf"}) {
    const auto read = read_ply(write(header + "end_header\n0 0 0 0 0 1 " + radius + "\n"));
    ASSERT_FALSE(read) << radius;
    EXPECT_NE(read.error().message.find("property radius"), std::string::npos) << read.error().message;
  }
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto mesh = read_ply(write(header + face + "0 0 0 0 0 1 0\n3 0 0 0\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_TRUE(mesh->radii_m.empty()) << "a mesh with faces is a surface already";
}

TEST_F(PlyFile, CountsAreWholeNumbers) {
  for (const std::string count : {"1e9", "1.5", "3x", "-3"}) {
    std::string header = kAsciiHeader;
    header.replace(header.find("vertex 3"), 8, "vertex " + count);
    const auto read = read_ply(write(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    ASSERT_FALSE(read) << count;
    EXPECT_NE(read.error().message.find("'" + count + "'"), std::string::npos) << read.error().message;
  }
}

TEST_F(PlyFile, HasTheDocumentedLayout) {
  ASSERT_TRUE(write_ply(tetrahedron(), folder_ / "mesh.ply"));
  const std::string bytes = bytes_of(folder_ / "mesh.ply");
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  ASSERT_EQ(bytes.substr(0, header.size()), header);
  ASSERT_EQ(bytes.size(), header.size() + 4 * 27 + 4 * 13);
  EXPECT_EQ(bytes.substr(header.size() + 27, 4), std::string("\x00\x00\xc0\x3f", 4));  // 1.5
  EXPECT_EQ(bytes.substr(header.size() + 27 + 24, 3), "\xff\xfe\xfd");                 // its colour
  EXPECT_EQ(bytes.substr(header.size() + 4 * 27, 13),
            std::string("\3\0\0\0\0\2\0\0\0\1\0\0\0", 13));  // 0 2 1
}

TEST_F(PlyFile, ReportsWhatCannotBeWritten) {
  const auto missing = write_ply(tetrahedron(), folder_ / "no_such_folder" / "mesh.ply");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::io);
  EXPECT_NE(missing.error().message.find("no_such_folder/mesh.ply"), std::string::npos);
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "/dev/full is not there to play the full disk";
  const auto full = write_ply(tetrahedron(), "/dev/full");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::io);
}

TEST_F(PlyFile, ReadsAsciiWithPolygonsExtrasAndCarriageReturns) {
  const auto mesh = read_ply(write(
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 5\r\nproperty double x\r\nproperty "
      "double y\r\n"
      "property double z\r\nproperty float confidence\r\nproperty uchar red\r\nproperty uchar "
      "green\r\nproperty uchar blue\r\n"
      "element material 1\r\nproperty list uchar float shades\r\n"
      "element face 2\r\nproperty uchar flags\r\nproperty list uchar uint vertex_index\r\nend_header\r\n"
      "0 0 0 0.5 1 2 3\r\n1 0 0 0.5 4 5 6\r\n1 1 0 0.5 7 8 9\r\n0 1 0 0.5 10 11 12\r\n-1 0.5 1e-3 1 255 0 "
      "255\r\n"
      "2 0.25 0.75\r\n0 4 0 1 2 3\r\n1 3 0 3 4\r\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->vertices.size(), 5U);
  EXPECT_EQ(mesh->vertices[4], Vector3d(-1, 0.5, 1e-3));
  EXPECT_EQ(mesh->colors[4], (Rgb{255, 0, 255}));
  EXPECT_TRUE(mesh->normals.empty());
  const std::vector<std::array<std::uint32_t, 3>> expected = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(mesh->triangles, expected);
}

TEST_F(PlyFile, ReadsPointCloudsAndOtherTypesInBinary) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty short x\nproperty uchar tag\n"
      "property double y\nproperty int z\nend_header\n";
  bytes +=
      std::string("\xfe\xff\x07", 3) + std::string("\0\0\0\0\0\0\xf8\x3f", 8) + std::string("\x05\0\0\0", 4);
  const auto mesh = read_ply(write(bytes));
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->vertices.size(), 1U);
  EXPECT_EQ(mesh->vertices[0], Vector3d(-2, 1.5, 5));
  EXPECT_TRUE(mesh->triangles.empty());
}

TEST_F(PlyFile, ReadsBinaryOfEitherByteOrder) {
  const std::string header =
      "element vertex 3\nproperty float x\nproperty double y\nproperty short z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string vertex(
      "\x3f\xc0\0\0"
      "\x3f\xf8\0\0\0\0\0\0"
      "\xff\xfe",
      14);  // 1.5 1.5 -2
  const std::string face(
      "\3"
      "\0\0\0\0"
      "\0\0\0\1"
      "\0\0\0\2",
      13);
  const auto mesh =
      read_ply(write("ply\nformat binary_big_endian 1.0\n" + header + vertex + vertex + vertex + face));
  ASSERT_TRUE(mesh) << mesh.error().message;
  for (const Vector3d& read : mesh->vertices) EXPECT_EQ(read, Vector3d(1.5, 1.5, -2));
  EXPECT_EQ(mesh->triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
}

TEST_F(PlyFile, ReportsAMissingFile) {
  for (const fs::path& file : {folder_ / "none.ply", folder_}) {
    const auto mesh = read_ply(file);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::data_missing);
    EXPECT_NE(mesh.error().message.find(file.string()), std::string::npos);
  }
}

TEST_F(PlyFile, RefusesEveryTruncation) {
  ASSERT_TRUE(write_ply(tetrahedron(), folder_ / "whole.ply"));
  const std::string bytes = bytes_of(folder_ / "whole.ply");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto mesh = read_ply(write(bytes.substr(0, size)));
    ASSERT_FALSE(mesh) << size;
    ASSERT_EQ(mesh.error().code, ErrorCode::data_corrupt);
  }
  expect_corrupt(bytes.substr(0, bytes.size() - 1), "byte " + std::to_string(bytes.size() - 4) +
                                                        ": the file ends before property vertex_indices");
}

TEST_F(PlyFile, NamesTheLineAndTheProperty) {
  expect_corrupt(kAsciiHeader + "0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n",
                 ".ply:12: property y: 'one' is not a number");
  expect_corrupt(kAsciiHeader + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", ".ply:11: property z is not finite");
  expect_corrupt(kAsciiHeader + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                 ".ply:13: property vertex_indices: vertex 3 of 3");
  expect_corrupt(kAsciiHeader + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "vertex -1 of 3");
  expect_corrupt(kAsciiHeader + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "a face of 2 vertices");
}

TEST_F(PlyFile, RefusesHeadersItCannotTrust) {
  const auto with = [](const std::string& lines) {
    return "ply\nformat ascii 1.0\n" + lines + "end_header\n";
  };
  expect_corrupt("solid cube\n", ".ply:1: the first line is not 'ply'");
  expect_corrupt("ply\nformat binary_middle_endian 1.0\nend_header\n", ".ply:2: format binary_middle_endian");
  expect_corrupt("ply\nelement vertex 0\nend_header\n", "no format line");
  expect_corrupt(with(""), "no element vertex");
  expect_corrupt(with("element vertex 1\nproperty float x\nproperty float y\n"), "no properties x, y and z");
  expect_corrupt(with("element vertex 1\nproperty float128 x\n"),
                 ".ply:4: property x: unknown type 'float128'");
  expect_corrupt(with("element vertex 1\nproperty list real int x\n"), "unknown type 'real'");
  expect_corrupt(with("property float x\n"), "before the first element");
  expect_corrupt(with("element vertex 99999999999\n"), "element vertex = 99999999999");
  expect_corrupt(with("element vertex many\n"), ".ply:3: expected 'element NAME COUNT'");
  expect_corrupt(with("elements vertex 1\n"), "unknown header keyword 'elements'");
}

TEST_F(PlyFile, RefusesColoursOutOfRange) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float red\nproperty float green\nproperty float blue\nend_header\n";
  expect_corrupt(header + "0 0 0 255 256 0\n", "property green = 256 (expected an integer in 0-255)");
  expect_corrupt(header + "0 0 0 0.5 0 0\n", "property red = 0.5");
}

}  // namespace
}  // namespace fusebench
