#include "datasets/calibration/distortion_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/base/io/lower_case.hpp"
#include "core/base/printable.hpp"

namespace fusebench::calibration {

namespace {

/// Without case and separators.
constexpr std::array<std::string_view, 8> kRadialTangential = {
    "", "radialtangential", "radtan", "pinholeradtan", "plumbbob", "brown", "brownconrady", "opencv"};

std::string plain_name(std::string_view name) {
  std::string plain = io::lower_case(name);
  std::erase_if(plain, [](char c) { return c == '-' || c == '_' || c == ' '; });
  return plain;
}

}  // namespace

Result<BrownConrady> distortion_of_model(std::string_view model, std::span<const double> coefficients) {
  constexpr std::size_t kMost = 5;
  const auto is_zero = [](double coefficient) { return coefficient == 0; };
  if (std::ranges::all_of(coefficients, is_zero)) return BrownConrady{};
  constexpr const char* kHint =
      "undistort the images with the program that calibrated them, and set the coefficients to 0";
  if (std::ranges::find(kRadialTangential, plain_name(model)) == kRadialTangential.end()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("distortion model {} is not supported (supported is radial-tangential, also "
                            "called radtan, plumb_bob, brown_conrady or opencv, and any model whose "
                            "coefficients are 0)",
                            printable(model, 60)),
                kHint);
  }
  if (coefficients.size() > kMost && !std::ranges::all_of(coefficients.subspan(kMost), is_zero)) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("distortion has {} coefficients (supported are k1 k2 p1 p2 k3; others must be 0)",
                            coefficients.size()),
                kHint);
  }
  const auto k = [&](std::size_t i) { return i < coefficients.size() ? coefficients[i] : 0.0; };
  return BrownConrady{k(0), k(1), k(2), k(3), k(4)};
}

}  // namespace fusebench::calibration
