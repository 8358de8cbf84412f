#include "datasets/recording/reading/regular_stamps.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::reading {

namespace {

constexpr std::size_t kMinStamps = 10;
constexpr double kReachFrames =
    15;  // half a second at 30 Hz: jitter averages out, clock drift does not matter

/// From intervals over four frames: single ones may come in two kinds, of which neither is the period, while
/// jitter that alternates, one by one or in pairs, cancels over four. The lower quartile, since images are
/// dropped: it holds up to one dropped image in four.
double period_ns(std::span<const std::int64_t> stamps_ns) {
  constexpr std::size_t kFrames = 4;
  std::vector<std::int64_t> intervals;
  for (std::size_t i = kFrames; i < stamps_ns.size(); ++i) {
    intervals.push_back(stamps_ns[i] - stamps_ns[i - kFrames]);
  }
  const auto quartile = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 4);
  std::nth_element(intervals.begin(), quartile, intervals.end());
  return static_cast<double>(*quartile) / static_cast<double>(kFrames);
}

/// Number of each image as the camera counted, dropped ones included.
std::vector<double> frame_numbers(std::span<const std::int64_t> stamps_ns, double frame_period_ns) {
  std::vector<double> numbers{0};
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    const double periods = static_cast<double>(stamps_ns[i] - stamps_ns[i - 1]) / frame_period_ns;
    numbers.push_back(numbers.back() + std::max(1.0, std::round(periods)));
  }
  return numbers;
}

/// How far the least-squares line through the neighbours [begin, end) lies after the stamp of `at`, at its
/// frame number.
double line_at(std::span<const std::int64_t> stamps_ns, const std::vector<double>& numbers, std::size_t begin,
               std::size_t end, std::size_t at) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t j = begin; j < end; ++j) {
    const double x = numbers[j] - numbers[at];
    const double y = static_cast<double>(stamps_ns[j] - stamps_ns[at]);
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double determinant = n * sxx - sx * sx;
  return determinant > 0 ? (sxx * sy - sx * sxy) / determinant : 0.0;
}

}  // namespace

std::optional<RegularStamps> regular_stamps(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < kMinStamps) return std::nullopt;
  const double frame_period_ns = period_ns(stamps_ns);
  const std::vector<double> numbers = frame_numbers(stamps_ns, frame_period_ns);
  RegularStamps result;
  double squares = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    while (numbers[begin] < numbers[i] - kReachFrames) ++begin;
    while (end < numbers.size() && numbers[end] <= numbers[i] + kReachFrames) ++end;
    const double offset_ns = line_at(stamps_ns, numbers, begin, end, i);
    if (std::abs(offset_ns) > 0.5 * frame_period_ns) return std::nullopt;
    result.capture_ns.push_back(stamps_ns[i] + std::llround(offset_ns));
    if (i > 0 && result.capture_ns[i] <= result.capture_ns[i - 1]) return std::nullopt;
    squares += offset_ns * offset_ns;
    result.jitter_max_s = std::max(result.jitter_max_s, 1e-9 * std::abs(offset_ns));
  }
  result.jitter_rms_s = 1e-9 * std::sqrt(squares / static_cast<double>(stamps_ns.size()));
  return result;
}

}  // namespace fusebench::reading
