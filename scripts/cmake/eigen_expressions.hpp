// The types of Eigen's expressions that most sources use, for the precompiled headers (rooms.cmake). GCC
// needs about 20 ms for each of them, in every compilation that uses it. Only types are completed: no
// function is compiled, no result depends on this file, and no source includes it.
#pragma once

#include <Eigen/Dense>

namespace fusebench::precompiled {

/// Values for expressions that are not evaluated.
template <class T>
const T& a() noexcept;

template <class... T>
inline constexpr bool complete = ((sizeof(T) > 0) && ...);

/// v, 0, -v, a + b, a - b, s v, v / s, a + s b, squared norm.
template <class Vector>
inline constexpr bool vector_space =
    complete<Vector, decltype(Vector::Zero()), decltype(-a<Vector>()), decltype(a<Vector>() + a<Vector>()),
             decltype(a<Vector>() - a<Vector>()), decltype(2.0 * a<Vector>()), decltype(a<Vector>() / 2.0),
             decltype(a<Vector>() + 2.0 * a<Vector>()), decltype(a<Vector>().cwiseAbs2())>;

/// A B, and the rows and columns that its coefficients are computed of.
template <class Left, class Right>
inline constexpr bool product =
    complete<decltype(a<Left>() * a<Right>()), decltype(a<Left>().lazyProduct(a<Right>())),
             decltype(a<Left>().row(0)), decltype(a<Left>().row(0).transpose()), decltype(a<Right>().col(0)),
             decltype(a<Left>().row(0).transpose().cwiseProduct(a<Right>().col(0)))>;

template <class Matrix>
inline constexpr bool square_matrix =
    complete<Matrix, decltype(Matrix::Zero()), decltype(Matrix::Identity()), decltype(2.0 * a<Matrix>()),
             decltype(a<Matrix>().transpose()), decltype(a<Matrix>().diagonal())>;

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Matrix3f;
using Eigen::Vector2d, Eigen::Vector3d, Eigen::Vector4d, Eigen::VectorXd;
using Eigen::Vector2f, Eigen::Vector3f, Eigen::Vector2i, Eigen::Vector3i;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

static_assert(vector_space<Vector3d> && square_matrix<Matrix3d> && product<Matrix3d, Vector3d>);
static_assert(complete<Vector2d, decltype(Vector2d::Zero()), Vector2f, decltype(Vector2f::Zero()), Vector3f,
                       decltype(Vector3f::Zero()), Matrix3f, Vector2i, Vector3i, Matrix2d>);
static_assert(complete<Vector6d, decltype(Vector6d::Zero()), decltype(2.0 * a<Vector6d>()),
                       decltype(a<Vector6d>().head<3>())>);
static_assert(square_matrix<Matrix6d>);
// Quaternions: norm, vector part, and the motion of a point.
static_assert(complete<Vector4d, decltype(a<Vector4d>() / 2.0), decltype(a<Vector4d>().cwiseAbs2()),
                       decltype(a<Vector4d>().head<3>()),
                       decltype(a<Vector3d>() + 2.0 * a<Vector3d>() + a<Vector3d>())>);
// Right-hand sides of large products.
static_assert(
    complete<MatrixXd, VectorXd, decltype(VectorXd::Zero()), Eigen::Map<VectorXd, Eigen::AlignedMax>,
             decltype(2.0 * a<Eigen::Map<VectorXd, Eigen::AlignedMax>>())>);

}  // namespace fusebench::precompiled
