// How large the residuals of the update were beside what their weights expect, over a run.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>

namespace fusebench::metrics {

/// Of the update of one frame. The means are of squared whitened residuals (1 is what the noise model
/// expects); nothing if the frame has none of that kind.
struct FrameResiduals {
  std::optional<double> chi2_photometric;
  std::optional<double> chi2_geometric;
  int patches_tracked = 0;
  int patches_accepted = 0;
};

/// Means over frames: each frame counts once, however many residuals it has. NaN where no frame has any.
struct ResidualSummary {
  double chi2_photometric = std::numeric_limits<double>::quiet_NaN();
  double chi2_geometric = std::numeric_limits<double>::quiet_NaN();
  double patches_tracked = std::numeric_limits<double>::quiet_NaN();
  double patches_accepted = std::numeric_limits<double>::quiet_NaN();
  double accepted_share = std::numeric_limits<double>::quiet_NaN();  ///< of all tracked patches of the run
  std::size_t frames = 0;
};

/// Takes frames in order.
class ResidualAccumulator {
 public:
  void add_frame(const FrameResiduals& frame);
  [[nodiscard]] ResidualSummary result() const;

 private:
  struct Mean {
    double sum = 0;
    std::size_t count = 0;
    void add(double value);
    [[nodiscard]] double value() const;
  };
  Mean chi2_photometric_;
  Mean chi2_geometric_;
  Mean patches_tracked_;
  Mean patches_accepted_;
};

}  // namespace fusebench::metrics
