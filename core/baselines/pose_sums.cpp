#include "core/baselines/pose_sums.hpp"

namespace fusebench::baselines {

PoseSums& PoseSums::operator+=(const PoseSums& other) {
  information += other.information;
  descent += other.descent;
  cost += other.cost;
  pixels += other.pixels;
  return *this;
}

PoseSums PoseSums::mean() const { return {information / pixels, descent / pixels, cost / pixels, pixels}; }

void PoseSumLanes::add(const std::array<simd::Float8, 6>& direction, simd::Float8 first_weight,
                       simd::Float8 second_weight, simd::Float8 cost, simd::Int8 valid) {
  const simd::Float8 none = {};
  const simd::Float8 first = valid ? first_weight : none;
  const simd::Float8 second = valid ? second_weight : none;
  std::size_t entry = 0;
  for (std::size_t row = 0; row < direction.size(); ++row) {
    // Values of a pixel without a match are arbitrary, possibly NaN.
    const simd::Float8 along = valid ? direction[row] : none;
    descent_[row] = simd::multiply_add(first, along, descent_[row]);
    const simd::Float8 weighted = second * along;
    for (std::size_t column = row; column < direction.size(); ++column, ++entry) {
      information_[entry] =
          simd::multiply_add(weighted, valid ? direction[column] : none, information_[entry]);
    }
  }
  cost_ += valid ? cost : none;
  pixels_ += valid ? simd::all_lanes(1.0F) : none;
}

PoseSums PoseSumLanes::total() const {
  PoseSums sums;
  std::size_t entry = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column, ++entry) {
      sums.information(row, column) = simd::sum_of_lanes(information_[entry]);
      sums.information(column, row) = sums.information(row, column);
    }
    sums.descent[row] = simd::sum_of_lanes(descent_[static_cast<std::size_t>(row)]);
  }
  sums.cost = simd::sum_of_lanes(cost_);
  sums.pixels = simd::sum_of_lanes(pixels_);
  return sums;
}

}  // namespace fusebench::baselines
