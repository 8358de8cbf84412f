#include "core/relocalisation/agreeing_places.hpp"

#include "core/base/geometry.hpp"
#include "core/base/solvers.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/relocalisation_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench::relocalisation {

namespace {

/// Of a gyroscope that nobody calibrated: scale and axes, as a share of the angle, and what the images are
/// late by or early.
constexpr double kGyroscopeShare = 0.03;
constexpr double kGyroscopeFloor_rad = 0.005;

double squared(double value) { return value * value; }

/// Of the pose against the world of the model, in its tangent.
Matrix6d covariance_of(const RelocalisedPose& pose) { return pose.covariance + pose.reference_covariance; }

}  // namespace

double squared_disagreement(const RefusedPlace& a, const RefusedPlace& b, const config::TermsConfig& terms,
                            const config::InitialisationConfig& initialisation) {
  const double apart_s = seconds_between(a.timestamp_ns, b.timestamp_ns);
  const Quaterniond turn = a.T_world_imu_predicted.rotation.conjugate() * b.T_world_imu_predicted.rotation;
  const bool gyroscope = terms.prior == config::Prior::imu;
  const SE3 expected{a.pose.T_world_imu.rotation * (gyroscope ? turn : Quaterniond::Identity()),
                     a.pose.T_world_imu.translation};
  const double rotation_sigma_rad =
      gyroscope ? kGyroscopeFloor_rad + kGyroscopeShare * rotation_angle_rad(turn, Quaterniond::Identity())
                : initialisation.angular_velocity_sigma_radps * apart_s;
  Matrix6d covariance = covariance_of(a.pose) + covariance_of(b.pose);
  covariance.diagonal().head<3>().array() += squared(rotation_sigma_rad);
  covariance.diagonal().tail<3>().array() += squared(initialisation.moving_velocity_sigma_mps * apart_s);
  const Vector6d error = pose_minus(b.pose.T_world_imu, expected);
  return error.dot(covariance.ldlt().solve(error));
}

bool AgreeingPlaces::is_recent(std::int64_t timestamp_ns) const {
  return agreeing_ > 0 &&
         seconds_between(last_.timestamp_ns, timestamp_ns) <= relocalisation_.agreeing_within_s;
}

void AgreeingPlaces::add(const RefusedPlace& place) {
  const bool agrees = is_recent(place.timestamp_ns) &&
                      squared_disagreement(last_, place, terms_, initialisation_) <= loops_.agreeing_chi2;
  if (!agrees) {
    first_ = place;
    agreeing_ = 0;
  }
  ++agreeing_;
  last_ = place;
}

bool AgreeingPlaces::are_enough() const { return agreeing_ >= relocalisation_.agreeing_frames; }

std::optional<filter::FilterState> AgreeingPlaces::motion(std::int64_t timestamp_ns,
                                                          const filter::FilterState& predicted) const {
  if (agreeing_ < 2 || !is_recent(timestamp_ns)) return std::nullopt;
  filter::FilterState state = predicted;
  const SE3& T_world_imu = last_.pose.T_world_imu;
  // The world of the model, in which the camera has turned since as predicted.
  state.T_world_imu = {T_world_imu.rotation * last_.T_world_imu_predicted.rotation.conjugate() *
                           predicted.T_world_imu.rotation,
                       T_world_imu.translation};
  state.velocity_world_mps = (T_world_imu.translation - first_.pose.T_world_imu.translation) /
                             seconds_between(first_.timestamp_ns, last_.timestamp_ns);
  return state;
}

void AgreeingPlaces::clear() { agreeing_ = 0; }

}  // namespace fusebench::relocalisation
