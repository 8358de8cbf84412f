#include "core/frame_update.hpp"

#include <algorithm>

namespace fusebench::core {

double misfit(std::span<const measurement::PatchOutcome> outcomes, const config::IekfConfig& config) {
  double sum = 0;
  int count = 0;
  for (const measurement::PatchOutcome& outcome : outcomes) {
    if (!outcome.in_view) continue;
    ++count;
    const bool fits = outcome.tracked && !outcome.contradicts_color && outcome.photometric_residuals > 0;
    sum += fits ? std::min(outcome.chi2_photometric / outcome.photometric_residuals,
                           config.max_chi2_per_measurement)
                : config.max_chi2_per_measurement;
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
  const double first_misfit = misfit(measurement_.outcomes(), config_.iekf);
  if (thorough || !(first_misfit > config_.health.suspicious_misfit)) return first;
  const alignment::FoundStart other = search_.find(prior, reference.points, frame.whole_pyramid(), true);
  filter::IekfResult second = update_from(other.start);
  if (misfit(measurement_.outcomes(), config_.iekf) < first_misfit) return second;
  return update_from(first.solution);
}

}  // namespace fusebench::core
