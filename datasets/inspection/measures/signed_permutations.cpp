#include "datasets/inspection/measures/signed_permutations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fusebench::inspection::measures {

namespace {

std::vector<Matrix3d> all_permutations() {
  std::vector<Matrix3d> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d matrix = Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        matrix(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) == 0 ? 1 : -1;
      all.push_back(matrix);
    }
  } while (std::ranges::next_permutation(order).found);
  const auto changed = [](const Matrix3d& matrix) { return 3 - matrix.diagonal().sum(); };
  std::ranges::stable_sort(all, [&](const Matrix3d& a, const Matrix3d& b) {
    if ((a.determinant() > 0) != (b.determinant() > 0)) return a.determinant() > 0;
    return changed(a) < changed(b);
  });
  return all;
}

bool is_clearly_better(double cost, double other, double alternatives, double freedom) {
  constexpr double kShare = 0.5;
  constexpr double kProbability = 1e-3;  // that one of the alternatives is better by chance
  if (!(cost <= kShare * other)) return false;
  if (cost <= 0) return other > 0;
  return 0.5 * freedom * std::log(other / cost) > std::log(alternatives / kProbability);
}

}  // namespace

std::span<const Matrix3d> signed_permutations() {
  static const std::vector<Matrix3d> kAll = all_permutations();
  return kAll;
}

std::string permutation_text(const Matrix3d& permutation, const std::array<std::string_view, 3>& names,
                             const std::array<std::string_view, 3>& negative) {
  std::string text = "(";
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      const double value = permutation(row, column);
      if (value == 0) continue;
      const auto axis = static_cast<std::size_t>(column);
      const bool has_name = value < 0 && !negative[axis].empty();
      text += fmt::format("{}{}{}", row == 0 ? "" : ", ", value < 0 && !has_name ? "-" : "",
                          has_name ? negative[axis] : names[axis]);
    }
  }
  return text + ")";
}

AxesChoice choose_axes(std::span<const double> costs, std::size_t given, double freedom) {
  const auto alternatives = static_cast<double>(costs.size() - 1);
  AxesChoice choice;
  choice.index = given;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (costs[i] < costs[choice.index]) choice.index = i;
  }
  const double best = costs[choice.index];
  choice.ratio = costs[given] > 0 ? std::sqrt(best / costs[given]) : 1;
  choice.is_clear = choice.index != given && is_clearly_better(best, costs[given], alternatives, freedom);
  if (!choice.is_clear) {
    choice.index = given;
    choice.ratio = 1;
    return choice;
  }
  choice.is_unique = true;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (i != choice.index && !is_clearly_better(best, costs[i], alternatives, freedom))
      choice.is_unique = false;
  }
  return choice;
}

}  // namespace fusebench::inspection::measures
