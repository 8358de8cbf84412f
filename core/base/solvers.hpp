// Eigen's solvers for three and six unknowns, instantiated once in solvers.cpp, since each takes seconds to
// compile. Calls need no change. Calls with an expression as the argument, not a matrix, are instantiated at
// the place of the call.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "core/base/geometry.hpp"

extern template Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>&
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>::compute(const Eigen::EigenBase<Eigen::Matrix3d>&, int);
extern template Eigen::JacobiSVD<Eigen::Matrix3d>& Eigen::JacobiSVD<Eigen::Matrix3d>::compute(
    const Eigen::Matrix3d&, unsigned int);
extern template Eigen::SelfAdjointEigenSolver<fusebench::Matrix6d>&
Eigen::SelfAdjointEigenSolver<fusebench::Matrix6d>::compute(const Eigen::EigenBase<fusebench::Matrix6d>&,
                                                            int);
extern template Eigen::LLT<fusebench::Matrix6d>& Eigen::LLT<fusebench::Matrix6d>::compute(
    const Eigen::EigenBase<fusebench::Matrix6d>&);
extern template Eigen::LDLT<fusebench::Matrix6d>& Eigen::LDLT<fusebench::Matrix6d>::compute(
    const Eigen::EigenBase<fusebench::Matrix6d>&);
extern template void Eigen::LDLT<fusebench::Matrix6d>::_solve_impl_transposed<true>(
    const fusebench::Vector6d&, fusebench::Vector6d&) const;
extern template void Eigen::LDLT<fusebench::Matrix6d>::_solve_impl_transposed<true>(
    const fusebench::Matrix6d::IdentityReturnType&, fusebench::Matrix6d&) const;
extern template void Eigen::PartialPivLU<fusebench::Matrix6d>::compute();
