#include "datasets/icl_models.hpp"

#include <Eigen/SVD>
#include <array>

namespace fusebench {

namespace {

Eigen::Matrix4d affine(const std::array<double, 12>& m) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(m.data());
  return T;
}

}  // namespace

std::span<const LivingRoomAlignment> living_room_alignments() {
  static const std::array<LivingRoomAlignment, 4> kAlignments = {{
      {"kt0", affine({0.999759, -0.000287637, 0.0219655, -1.36022,  //
                      0.000160294, 0.999983, 0.00579897, 1.48382,   //
                      0.0219668, 0.00579404, -0.999742, 1.44256})},
      {"kt1", affine({0.99975, -0.00789018, 0.0209474, -0.0976324,  //
                      0.00789931, 0.999969, -0.000353282, 1.27618,  //
                      0.0209439, -0.000518671, -0.999781, 0.0983734})},
      {"kt2", affine({0.999822, 0.0034419, 0.0185526, -0.786316,   //
                      -0.00350915, 0.999987, 0.00359374, 1.28433,  //
                      0.01854, 0.00365819, -0.999821, 1.45583})},
      {"kt3", affine({0.999778, -0.000715914, 0.0210893, -1.13311,  //
                      0.000583688, 0.99998, 0.0062754, 1.26825,     //
                      0.0210934, 0.0062617, -0.999758, 0.901866})},
  }};
  return kAlignments;
}

SE3 model_from_first_camera(const LivingRoomAlignment& alignment) {
  const Eigen::DiagonalMatrix<double, 3> turn_y(1, -1, 1);
  const Matrix3d R = alignment.T_model_icl.topLeftCorner<3, 3>() * turn_y;
  const Eigen::JacobiSVD<Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {Quaterniond(Matrix3d(svd.matrixU() * svd.matrixV().transpose())).normalized(),
          alignment.T_model_icl.topRightCorner<3, 1>()};
}

}  // namespace fusebench
