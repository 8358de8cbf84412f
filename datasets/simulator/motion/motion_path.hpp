// Shape of a hand-held path before it is scaled to its speeds: sums of sines, pans and shaking.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/geometry.hpp"
#include "datasets/simulator/motion/motion.hpp"

namespace fusebench::simulator::motion {

/// Unscaled functions of path time, with speeds of about one unit per second.
class HandPath {
 public:
  /// Mostly in the horizontal plane, as for a hand.
  static constexpr std::array<double, 3> kDefaultAxisWeights = {1.0, 1.0, 0.35};

  /// stretch: factors on the frequencies of the position by axis; weight: factors on its speeds. Pans last
  /// until length_s.
  HandPath(const MotionOptions& options, std::uint64_t seed, const Vector3d& stretch, double length_s,
           const std::array<double, 3>& weight = kDefaultAxisWeights);

  [[nodiscard]] Vector3d position(double path_s) const;
  [[nodiscard]] Vector3d angles(double path_s) const;  ///< yaw, pitch, roll relative to their means
  [[nodiscard]] Vector3d tremor(double path_s) const;  ///< amplitude of about one
  [[nodiscard]] Vector3d angle_tremor(double path_s) const;
  [[nodiscard]] double mean_yaw_rad() const { return mean_yaw_rad_; }

 private:
  struct Sine {
    double amplitude = 0;
    double rate_radps = 0;
    double phase_rad = 0;
  };
  using Sines = std::vector<Sine>;
  /// A minimum-jerk rotation from rest to rest.
  struct Pan {
    double begin_s = 0;
    double duration_s = 0;
    double angle = 0;
  };

  [[nodiscard]] static double sum(const Sines& sines, double path_s);
  [[nodiscard]] double pan(double path_s) const;
  [[nodiscard]] double shaking(double path_s) const;

  MotionOptions options_;
  std::array<Sines, 3> position_;
  std::array<Sines, 3> angles_;
  std::array<Sines, 3> shake_position_;
  std::array<Sines, 3> shake_angles_;
  std::array<Sines, 3> tremor_;
  std::array<Sines, 3> angle_tremor_;
  std::vector<Pan> pans_;
  double shake_phase_rad_ = 0;
  double mean_yaw_rad_ = 0;
};

}  // namespace fusebench::simulator::motion
