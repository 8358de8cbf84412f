#include "core/estimator/smoother/visual_scale.hpp"

namespace fusebench::smoother {

double correlation_factor(const std::vector<std::optional<Vector6d>>& residual_of_frame) {
  constexpr double kNegligible = 0.05;
  constexpr std::size_t kMaxLag = 30;
  double power = 0;
  double count = 0;
  for (const auto& r : residual_of_frame) {
    if (!r) continue;
    power += r->squaredNorm();
    count += 1;
  }
  double factor = 1;
  for (std::size_t lag = 1; lag <= kMaxLag; ++lag) {
    double product = 0;
    double pairs = 0;
    for (std::size_t k = lag; k < residual_of_frame.size(); ++k) {
      if (!residual_of_frame[k] || !residual_of_frame[k - lag]) continue;
      product += residual_of_frame[k]->dot(*residual_of_frame[k - lag]);
      pairs += 1;
    }
    if (pairs < 8) break;  // too few for an estimate
    const double correlation = (product / pairs) / (power / count);
    if (!(correlation > kNegligible)) break;
    factor += 2 * correlation;
  }
  return factor;
}

}  // namespace fusebench::smoother
