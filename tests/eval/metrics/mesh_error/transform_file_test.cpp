#include "eval/metrics/mesh_error/transform_file.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/geometry.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace mesh_error;

namespace {

class TransformFile : public testing::InTemporaryFolder {
 protected:
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const auto read = read_transform(write("transform.txt", text));
    EXPECT_FALSE(read.has_value());
    return read ? "was not refused" : read.error().message;
  }
};

TEST_F(TransformFile, ReadsFourLinesOrOne) {
  const std::string rows[] = {"0 -1 0 1.5\n", "1 0 0 -2\n", "0 0 1 0.25\n", "0 0 0 1\n"};
  for (const std::string& text : {rows[0] + rows[1] + rows[2] + rows[3], rows[0] + rows[1] + rows[2],
                                  std::string("0 -1 0 1.5 1 0 0 -2 0 0 1 0.25 0 0 0 1")}) {
    const auto read = read_transform(write("transform.txt", text));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->translation, Vector3d(1.5, -2, 0.25));
    EXPECT_LT(rotation_angle_rad(read->rotation, so3_exp({0, 0, std::numbers::pi / 2})), 1e-12);
  }
}

TEST_F(TransformFile, RefusesWhatIsNotRigid) {
  EXPECT_NE(refusal("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n").find("no rotation (determinant 8"),
            std::string::npos);
  EXPECT_NE(refusal("1 0 0 0\n0 1 0 0\n0 0 -1 0\n").find("no rotation (determinant -1"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n").find("column by column"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0\n0 1 0 0\n").find("8 numbers"), std::string::npos);
  EXPECT_NE(refusal("1 0 0\n").find("transform.txt:1"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 nan\n").find("nan"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0\n0 1 0 0\n0 0 1 -1e308\n").find("translation 0 0 -1e+308"), std::string::npos);
  EXPECT_EQ(read_transform(folder_ / "none.txt").error().code, ErrorCode::data_missing);
}

}  // namespace
}  // namespace fusebench
