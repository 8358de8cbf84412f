#include "datasets/icl_models.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/datasets/icl_folder.hpp"

namespace fusebench {
namespace {

TEST(IclModels, PublishedTransformsAreReflections) {
  ASSERT_EQ(living_room_alignments().size(), 4U);
  for (const LivingRoomAlignment& alignment : living_room_alignments()) {
    const Matrix3d R = alignment.T_model_icl.topLeftCorner<3, 3>();
    EXPECT_NEAR(R.determinant(), -1, 5e-6) << alignment.trajectory;
    EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 5e-5) << alignment.trajectory;
    EXPECT_EQ(alignment.T_model_icl.row(3), Eigen::RowVector4d(0, 0, 0, 1));
  }
}

TEST(IclModels, WithTheReflectionOfTheCameraTheyAreRigid) {
  for (const LivingRoomAlignment& alignment : living_room_alignments()) {
    const SE3 T = model_from_first_camera(alignment);
    const Vector3d point_camera(0.3, -0.2, 1.5);
    const Eigen::Vector4d point_icl(0.3, 0.2, 1.5, 1);  // the same point with y up
    EXPECT_LT((T * point_camera - (alignment.T_model_icl * point_icl).head<3>()).norm(), 1e-4);
    EXPECT_NEAR(T.rotation_matrix().determinant(), 1, 1e-12);
    // The camera stands in the room, looks along -z of the model, and the model's y axis points up.
    EXPECT_LT(T.rotation_matrix().col(1).y(), -0.99) << alignment.trajectory;
    EXPECT_LT(T.rotation_matrix().col(2).z(), -0.99) << alignment.trajectory;
    EXPECT_GT(T.translation.y(), 1.2);
    EXPECT_LT(T.translation.y(), 1.5);
  }
}

/// The model is the rendered scene with its x axis turned around. The published transforms are near the
/// rendered first pose, not on it.
TEST(IclModels, NearTheFirstRenderedPose) {
  const auto cameras = testing::shared_recording("icl_nuim_trajectories");
  if (!cameras) GTEST_SKIP() << "FUSEBENCH_DATA does not hold icl_nuim_trajectories";
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
    std::ifstream file(*cameras / ("povray_camera_kt" + std::to_string(k) + ".txt"));
    std::string line;
    std::getline(file, line);  // comment
    for (int index = 0; index < 2; ++index) {
      std::getline(file, line);
      std::istringstream row(line);
      int read = -1;
      Eigen::Matrix<double, 3, 4, Eigen::RowMajor> P;
      row >> read;
      for (int i = 0; i < 12; ++i) row >> P.data()[i];
      ASSERT_EQ(read, index);
      P.row(0) *= -1;
      const Eigen::Matrix<double, 3, 4> published = living_room_alignments()[k].T_model_icl.topRows<3>();
      const double apart_m = (published.col(3) - P.col(3)).norm();
      const Eigen::AngleAxisd turn(Matrix3d(published.leftCols<3>().transpose() * P.leftCols<3>()));
      std::printf("[ measured ] kt%zu: SurfReg against the rendered pose of frame %d: %.1f mm, %.2f deg\n", k,
                  index, 1e3 * apart_m, turn.angle() / radians(1));
      EXPECT_LT(apart_m, 0.05);
      EXPECT_LT(turn.angle(), radians(1));
    }
  }
}

}  // namespace
}  // namespace fusebench
