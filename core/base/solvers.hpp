// Eigen's solvers of three and six unknowns, compiled once (solvers.cpp): each takes seconds to compile, in
// every source that uses one. What is included here is used as ever; arguments that are expressions, not
// matrices, are compiled where they stand.
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
