#include "eval/metrics/mesh_error/error_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::mesh_error {

namespace {

// Viridis at ninths of its range.
constexpr std::array<std::array<double, 3>, 10> kViridis = {{{68, 1, 84},
                                                             {72, 40, 120},
                                                             {62, 74, 137},
                                                             {49, 104, 142},
                                                             {38, 130, 142},
                                                             {31, 158, 137},
                                                             {53, 183, 121},
                                                             {109, 205, 89},
                                                             {180, 222, 44},
                                                             {253, 231, 37}}};

constexpr Rgb kUnknown = {170, 170, 170};

Rgb color_at(double share) {
  if (!std::isfinite(share)) return kUnknown;
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double part = at - static_cast<double>(below);
  Rgb color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(
        std::lround((1 - part) * kViridis[below][c] + part * kViridis[below + 1][c]));
  }
  return color;
}

}  // namespace

std::vector<Rgb> error_colors(std::span<const double> errors, double largest) {
  check(largest > 0, "a range of errors");
  std::vector<Rgb> colors;
  colors.reserve(errors.size());
  for (const double error : errors) colors.push_back(color_at(error / largest));
  return colors;
}

}  // namespace fusebench::mesh_error
