#include "core/frame_update.hpp"

#include <algorithm>

namespace fusebench::core {

double agreement(std::span<const measurement::PatchOutcome> outcomes) {
  double sum = 0;
  int count = 0;
  for (const measurement::PatchOutcome& outcome : outcomes) {
    if (!outcome.in_view) continue;
    ++count;
    if (outcome.tracked) sum += outcome.correlation;
  }
  return count > 0 ? sum / count : 0.0;
}

filter::IekfResult FrameUpdate::run(const filter::GaussianState& prior,
                                    const alignment::TrackingReference& reference,
                                    const FramePreparation& frame, const Novelty& novelty,
                                    const measurement::ResidualScale& scale, bool thorough) {
  const auto update_from = [&](const filter::MeasuredVector& start) {
    measurement_.observe(frame.observed(novelty), reference.patches, scale);  // Eqs. 1-5, in each iterate
    return filter::iekf_update(prior, measurement_, config_.iekf, start);     // Eqs. 15-23
  };
  if (!novelty.color || config_.terms.photometric_weight <= 0)
    return update_from(filter::MeasuredVector::Zero());
  const alignment::FoundStart found = search_.find(prior, reference.points, frame.whole_pyramid(), thorough);
  filter::IekfResult first = update_from(found.start);
  // With a prediction that is near enough there is no other basin.
  const double first_agreement = agreement(measurement_.outcomes());
  if (thorough || found.coarsest_level < 0 || first_agreement >= config_.health.sure_correlation)
    return first;
  const alignment::FoundStart other = search_.find(prior, reference.points, frame.whole_pyramid(), true);
  filter::IekfResult second = update_from(other.start);
  if (agreement(measurement_.outcomes()) > first_agreement) return second;
  return update_from(first.solution);
}

}  // namespace fusebench::core
