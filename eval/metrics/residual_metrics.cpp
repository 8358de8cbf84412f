#include "eval/metrics/residual_metrics.hpp"

namespace fusebench::metrics {

void ResidualAccumulator::Mean::add(double value) {
  sum += value;
  ++count;
}

double ResidualAccumulator::Mean::value() const {
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
}

void ResidualAccumulator::add_frame(const FrameResiduals& frame) {
  if (frame.chi2_photometric) chi2_photometric_.add(*frame.chi2_photometric);
  if (frame.chi2_geometric) chi2_geometric_.add(*frame.chi2_geometric);
  patches_tracked_.add(frame.patches_tracked);
  patches_accepted_.add(frame.patches_accepted);
}

ResidualSummary ResidualAccumulator::result() const {
  ResidualSummary summary;
  summary.chi2_photometric = chi2_photometric_.value();
  summary.chi2_geometric = chi2_geometric_.value();
  summary.patches_tracked = patches_tracked_.value();
  summary.patches_accepted = patches_accepted_.value();
  if (patches_tracked_.sum > 0) summary.accepted_share = patches_accepted_.sum / patches_tracked_.sum;
  summary.frames = patches_tracked_.count;
  return summary;
}

}  // namespace fusebench::metrics
