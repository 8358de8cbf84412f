// Found poses that the prediction rules out. A filter that was wrong before it was lost claims too little of
// its error, and would refuse the right place for good; one false match, though, must not move it. So such a
// pose is believed once several frames in a row found their places, and these agree with each other.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/relocalisation/relocalisation_update.hpp"

namespace fusebench::relocalisation {

/// A pose that was found, and refused.
struct RefusedPlace {
  std::int64_t timestamp_ns = 0;
  RelocalisedPose pose;
  SE3 T_world_imu_predicted;  ///< when it was found
};

class AgreeingPlaces {
 public:
  /// The options must outlive it.
  AgreeingPlaces(const config::RelocalisationConfig& relocalisation, const config::LoopsConfig& loops,
                 const config::TermsConfig& terms, const config::InitialisationConfig& initialisation)
      : relocalisation_(relocalisation), loops_(loops), terms_(terms), initialisation_(initialisation) {}

  /// Stamps ascend. A place that does not agree with the one before, or comes later than
  /// relocalisation.agreeing_within_s, begins anew.
  void add(const RefusedPlace& place);

  /// True if relocalisation.agreeing_frames agree.
  [[nodiscard]] bool are_enough() const;

  /// The motion at a later stamp by the places that agree, where the prediction has lost it; nothing if there
  /// is one only, or the last was longer ago than agreeing_within_s. What places do not tell is the
  /// prediction's.
  [[nodiscard]] std::optional<filter::FilterState> motion(std::int64_t timestamp_ns,
                                                          const filter::FilterState& predicted) const;

  void clear();

 private:
  [[nodiscard]] bool is_recent(std::int64_t timestamp_ns) const;

  const config::RelocalisationConfig& relocalisation_;
  const config::LoopsConfig& loops_;
  const config::TermsConfig& terms_;
  const config::InitialisationConfig& initialisation_;
  RefusedPlace first_;  ///< these two: of those that agree
  RefusedPlace last_;
  int agreeing_ = 0;
};

/// The squared distance (six degrees of freedom) between the motion from a to b by their places and what is
/// known of it whatever the filter claims: with an IMU the rotation by the gyroscope; else, and of the
/// position, only that it is unknown like that of a start in motion (`initialisation`).
[[nodiscard]] double squared_disagreement(const RefusedPlace& a, const RefusedPlace& b,
                                          const config::TermsConfig& terms,
                                          const config::InitialisationConfig& initialisation);

}  // namespace fusebench::relocalisation
