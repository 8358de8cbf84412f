#include "core/base/solvers.hpp"

template Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>&
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>::compute(const Eigen::EigenBase<Eigen::Matrix3d>&, int);
template Eigen::JacobiSVD<Eigen::Matrix3d>& Eigen::JacobiSVD<Eigen::Matrix3d>::compute(const Eigen::Matrix3d&,
                                                                                       unsigned int);
template Eigen::SelfAdjointEigenSolver<fusebench::Matrix6d>&
Eigen::SelfAdjointEigenSolver<fusebench::Matrix6d>::compute(const Eigen::EigenBase<fusebench::Matrix6d>&,
                                                            int);
template Eigen::LLT<fusebench::Matrix6d>& Eigen::LLT<fusebench::Matrix6d>::compute(
    const Eigen::EigenBase<fusebench::Matrix6d>&);
template Eigen::LDLT<fusebench::Matrix6d>& Eigen::LDLT<fusebench::Matrix6d>::compute(
    const Eigen::EigenBase<fusebench::Matrix6d>&);
template void Eigen::LDLT<fusebench::Matrix6d>::_solve_impl_transposed<true>(const fusebench::Vector6d&,
                                                                             fusebench::Vector6d&) const;
template void Eigen::LDLT<fusebench::Matrix6d>::_solve_impl_transposed<true>(
    const fusebench::Matrix6d::IdentityReturnType&, fusebench::Matrix6d&) const;
template void Eigen::PartialPivLU<fusebench::Matrix6d>::compute();
