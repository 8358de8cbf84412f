#include "datasets/inspection/measures/order_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::inspection::measures {

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const double rank = fraction * static_cast<double>(values.size() - 1);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::llround(rank));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace fusebench::inspection::measures
