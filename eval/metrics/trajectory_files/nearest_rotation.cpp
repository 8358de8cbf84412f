#include "eval/metrics/trajectory_files/nearest_rotation.hpp"

#include "core/base/solvers.hpp"

namespace fusebench::trajectory_files {

NearestRotation nearest_rotation(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double deviation = matrix.determinant() <= 0
                               ? 1.0
                               : (matrix.transpose() * matrix - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return {svd.matrixU() * svd.matrixV().transpose(), deviation};
}

}  // namespace fusebench::trajectory_files
