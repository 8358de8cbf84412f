// Options: where an update starts.
#pragma once

namespace fusebench::config {

/// The search for the basin of convergence that an update starts in (not in the paper, whose prediction by
/// the IMU is near enough).
struct AlignmentConfig {
  int coarsest_level = 5;
  /// The level on which the alignment ends, and by whose cost starts are compared.
  static constexpr int finest_level = 3;
  /// A level converges from this far (its own pixels): gradients of a 10x10 patch are of about its size.
  static constexpr double reach_px = 2.5;
  /// Images are aligned before the patches where so many standard deviations of the predicted place of a
  /// pixel exceed the reach of the coarsest level of the patches, and from the first level whose reach they
  /// do not exceed.
  static constexpr double reach_sigmas = 2.0;
  double pixels_per_measurement = 10.0;
  /// Iterations of an alignment from one start, over all levels.
  static constexpr int max_iterations = 10;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("coarsest_level", self.coarsest_level, 0, 8,
             "coarsest pyramid level on which whole images are aligned (5 is 20x15 pixels for images of "
             "640x480); 0 disables the search");
    v.number("pixels_per_measurement", self.pixels_per_measurement, 1.0, 1000.0,
             "number of correlated residuals that count as one measurement, as for patches");
  }
};

}  // namespace fusebench::config
