#include "datasets/synthetic_imu/pose_spline.hpp"

#include <algorithm>

namespace fusebench::synthetic_imu {

namespace {

CumulativeBasis cubic_basis(double u, double spacing_s) {
  const double rate = 1.0 / spacing_s;
  CumulativeBasis basis;
  basis.weight = {(5 + u * (3 + u * (-3 + u))) / 6, (1 + u * (3 + u * (3 - 2 * u))) / 6, u * u * u / 6};
  basis.rate = {rate * (3 + u * (-6 + 3 * u)) / 6, rate * (3 + u * (6 - 6 * u)) / 6, rate * u * u / 2};
  basis.acceleration = {rate * rate * (u - 1), rate * rate * (1 - 2 * u), rate * rate * u};
  return basis;
}

}  // namespace

PoseSpline::PoseSpline(std::int64_t start_ns, std::int64_t end_ns, std::int64_t spacing_ns)
    : start_ns_(start_ns), spacing_ns_(spacing_ns) {
  check(spacing_ns > 0 && end_ns >= start_ns, "a spline needs a positive spacing and span");
  const auto segments = static_cast<std::size_t>((end_ns - start_ns) / spacing_ns) + 1;
  position_world_m.assign(segments + 3, Vector3d::Zero());
  rotation_world_body.assign(segments + 3, Quaterniond::Identity());
}

SplinePlace PoseSpline::place(std::int64_t timestamp_ns) const {
  const std::int64_t last = static_cast<std::int64_t>(position_world_m.size()) - 4;
  const std::int64_t segment = std::clamp((timestamp_ns - start_ns_) / spacing_ns_, std::int64_t{0}, last);
  const std::int64_t into_ns = timestamp_ns - start_ns_ - segment * spacing_ns_;
  const double u = static_cast<double>(into_ns) / static_cast<double>(spacing_ns_);
  return {static_cast<std::size_t>(segment), cubic_basis(u, seconds_between(0, spacing_ns_))};
}

Kinematics PoseSpline::evaluate(std::int64_t timestamp_ns) const {
  const SplinePlace at = place(timestamp_ns);
  Kinematics k;
  k.T_world_body = {rotation_world_body[at.segment], position_world_m[at.segment]};
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t i = at.segment + j;
    const Vector3d step = position_world_m[i + 1] - position_world_m[i];
    k.T_world_body.translation += at.basis.weight[j] * step;
    k.velocity_world_mps += at.basis.rate[j] * step;
    k.acceleration_world_mps2 += at.basis.acceleration[j] * step;

    const Vector3d turn = so3_log(rotation_world_body[i].conjugate() * rotation_world_body[i + 1]);
    const Quaterniond factor = so3_exp(at.basis.weight[j] * turn);
    k.T_world_body.rotation = (k.T_world_body.rotation * factor).normalized();
    // The rate so far is rotated to the axes after this factor; the axis of the factor is unchanged.
    k.angular_velocity_body_radps =
        factor.conjugate() * k.angular_velocity_body_radps + at.basis.rate[j] * turn;
  }
  return k;
}

}  // namespace fusebench::synthetic_imu
