#include "eval/metrics/trajectory_error/motion_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::trajectory_error {

namespace {

struct UnitSpelling {
  DeltaUnit unit;
  std::string_view letter;
  std::string_view name;
};

constexpr std::array kUnits{
    UnitSpelling{DeltaUnit::frames, "f", "frames"},   UnitSpelling{DeltaUnit::metres, "m", "metres"},
    UnitSpelling{DeltaUnit::degrees, "d", "deg"},     UnitSpelling{DeltaUnit::radians, "r", "rad"},
    UnitSpelling{DeltaUnit::seconds, "s", "seconds"},
};

double in_radians(const Delta& delta) {
  return delta.unit == DeltaUnit::degrees ? radians(delta.value) : delta.value;
}

double angle_between(const StampedPose& a, const StampedPose& b) {
  return rotation_angle_rad(a.T_world_camera.rotation, b.T_world_camera.rotation);
}

/// Angles from pose to pose, summed up (rad).
std::vector<double> turned_rad(const Trajectory& trajectory) {
  std::vector<double> sums(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    sums[i] = sums[i - 1] + angle_between(trajectory[i - 1], trajectory[i]);
  return sums;
}

/// The first index from `begin` on at which `sorted` reaches a value; it is looked for near `begin`.
std::size_t first_at_least(std::span<const double> sorted, std::size_t begin, double value) {
  std::size_t step = 1;
  while (begin + step < sorted.size() && sorted[begin + step] < value) step *= 2;
  const std::span<const double> near = sorted.subspan(begin, std::min(step + 1, sorted.size() - begin));
  return begin + static_cast<std::size_t>(std::ranges::lower_bound(near, value) - near.begin());
}

std::vector<double> times_s(const Trajectory& trajectory) {
  std::vector<double> times;
  times.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory)
    times.push_back(trajectory_files::stamp_seconds(pose.timestamp_ns));
  return times;
}

/// Marks at the first pose (if first_is_mark) and wherever the sum of steps since the last mark reaches
/// delta.
template <typename Step>
IndexPairs between_marks(std::size_t poses, double delta, bool first_is_mark, Step&& step) {
  IndexPairs pairs;
  std::optional<std::size_t> mark;
  if (first_is_mark) mark = 0;
  double since_mark = 0;
  for (std::size_t i = 1; i < poses; ++i) {
    since_mark += step(i);
    if (since_mark < delta) continue;
    if (mark) pairs.emplace_back(*mark, i);
    mark = i;
    since_mark = 0;
  }
  return pairs;
}

/// For each i the later j at which `along` (which does not decrease) differs from along[i] by nearest delta.
IndexPairs nearest_later(std::span<const double> along, double delta, double tolerance) {
  IndexPairs pairs;
  for (std::size_t i = 0; i + 1 < along.size(); ++i) {
    const auto later = along.subspan(i + 1);
    auto best = std::ranges::lower_bound(later, along[i] + delta);
    const auto miss = [&](auto place) { return std::abs(*place - along[i] - delta); };
    if (best == later.end() || (best != later.begin() && miss(best - 1) <= miss(best)))
      best = std::ranges::lower_bound(later.begin(), best, *(best - 1));
    if (miss(best) <= tolerance)
      pairs.emplace_back(i, i + 1 + static_cast<std::size_t>(best - later.begin()));
  }
  return pairs;
}

/// The bisection of TUM's scripts: of equal entries it returns the one that it meets first.
std::size_t bisected(std::span<const double> sorted, double wanted) {
  std::size_t begin = 0;
  std::size_t end = sorted.size();
  std::size_t best = 0;
  double least = std::abs(sorted[0] - wanted);
  while (begin < end) {
    const std::size_t middle = (begin + end) / 2;
    const double miss = std::abs(sorted[middle] - wanted);
    if (miss < least) {
      least = miss;
      best = middle;
    }
    if (sorted[middle] == wanted) return middle;
    if (sorted[middle] > wanted) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return best;
}

/// What a delta is measured along.
std::vector<double> measured_along(const Trajectory& trajectory, DeltaUnit unit) {
  std::vector<double> along;
  switch (unit) {
    case DeltaUnit::frames:
      for (std::size_t i = 0; i < trajectory.size(); ++i) along.push_back(static_cast<double>(i));
      return along;
    case DeltaUnit::metres:
      return path_lengths(trajectory);
    case DeltaUnit::degrees:
      along = turned_rad(trajectory);
      for (double& angle : along) angle = degrees(angle);
      return along;
    case DeltaUnit::radians:
      return turned_rad(trajectory);
    case DeltaUnit::seconds:
      break;
  }
  return times_s(trajectory);
}

}  // namespace

std::string_view to_string(DeltaUnit unit) {
  for (const UnitSpelling& spelling : kUnits) {
    if (spelling.unit == unit) return spelling.letter;
  }
  return "";
}

bool is_angle(DeltaUnit unit) { return unit == DeltaUnit::degrees || unit == DeltaUnit::radians; }

Result<DeltaUnit> parse_delta_unit(std::string_view text) {
  for (const UnitSpelling& spelling : kUnits) {
    if (text == spelling.letter || text == spelling.name) return spelling.unit;
  }
  return fail(ErrorCode::usage, fmt::format("unknown delta unit '{}'", text),
              "units are f (frames), m (metres), d (degrees), r (radians) and s (seconds)");
}

Result<void> check_compared(const MotionListing& listing, std::size_t compared) {
  if (compared <= listing.most_compared) return {};
  return fail(ErrorCode::usage,
              fmt::format("at least {} pairs of poses would have to be checked (allowed: up to {})", compared,
                          listing.most_compared),
              "take fewer poses (--downsample N or --motion_filter D A), or leave out --all_pairs");
}

Result<void> check_listing(const MotionListing& listing, std::size_t motions) {
  if (!listing.needed || motions <= listing.most) return {};
  constexpr double kBytesEach = 75;
  return fail(
      ErrorCode::usage,
      fmt::format("{} motions are too many to list each error, which would take {:.1f} GB (allowed: up "
                  "to {} motions)",
                  motions, kBytesEach * 1e-9 * static_cast<double>(motions), listing.most),
      "leave out --all_pairs or take fewer poses (--downsample N); without --errors and --all_errors, "
      "more are compared");
}

std::vector<double> path_lengths(const Trajectory& trajectory) {
  std::vector<double> lengths(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    lengths[i] =
        lengths[i - 1] +
        (trajectory[i].T_world_camera.translation - trajectory[i - 1].T_world_camera.translation).norm();
  }
  return lengths;
}

IndexPairs consecutive_motions(const Trajectory& trajectory, const Delta& delta) {
  const auto at = [&](std::size_t i) -> const SE3& { return trajectory[i].T_world_camera; };
  switch (delta.unit) {
    case DeltaUnit::frames: {
      IndexPairs pairs;
      const auto step = static_cast<std::size_t>(delta.value);
      for (std::size_t i = step; i < trajectory.size(); i += step) pairs.emplace_back(i - step, i);
      return pairs;
    }
    case DeltaUnit::metres:
      return between_marks(trajectory.size(), delta.value, delta.value <= 0,
                           [&](std::size_t i) { return (at(i).translation - at(i - 1).translation).norm(); });
    case DeltaUnit::degrees:
    case DeltaUnit::radians:
      return between_marks(trajectory.size(), in_radians(delta), true,
                           [&](std::size_t i) { return angle_between(trajectory[i - 1], trajectory[i]); });
    case DeltaUnit::seconds:
      break;
  }
  return between_marks(trajectory.size(), delta.value, true, [&](std::size_t i) {
    return 1e-9 * static_cast<double>(trajectory[i].timestamp_ns - trajectory[i - 1].timestamp_ns);
  });
}

IndexPairs all_motions(const Trajectory& trajectory, const Delta& delta, double tolerance) {
  if (delta.unit == DeltaUnit::frames) {
    IndexPairs pairs;
    const auto step = static_cast<std::size_t>(delta.value);
    for (std::size_t i = step; i < trajectory.size(); ++i) pairs.emplace_back(i - step, i);
    return pairs;
  }
  if (is_angle(delta.unit)) {
    IndexPairs pairs;
    visit_turns(trajectory, delta, tolerance, std::numeric_limits<std::size_t>::max(),
                [&](std::size_t i, std::size_t j) { pairs.emplace_back(i, j); });
    return pairs;
  }
  const std::vector<double> along = measured_along(trajectory, delta.unit);
  return nearest_later(along, delta.value, tolerance * delta.value);
}

// A direct angle changes by no more than the angles from pose to pose in between: where it misses the wanted
// ones by a gap, so do all poses until they have turned through it.
std::size_t visit_turns(const Trajectory& trajectory, const Delta& delta, double tolerance,
                        std::size_t most_compared, const MotionVisitor& visit) {
  constexpr double kRounding_rad = 1e-6;
  const double delta_rad = in_radians(delta);
  const double least_rad = delta_rad - tolerance * delta_rad;
  const double most_rad = delta_rad + tolerance * delta_rad;
  const std::vector<double> turned = turned_rad(trajectory);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    for (std::size_t j = i + 1; j < trajectory.size();) {
      if (++compared > most_compared) return compared;
      const double angle_rad = angle_between(trajectory[i], trajectory[j]);
      if (angle_rad >= least_rad && angle_rad <= most_rad) {
        visit(i, j++);
        continue;
      }
      const double gap_rad = std::max(least_rad - angle_rad, angle_rad - most_rad) - kRounding_rad;
      j = first_at_least(turned, j + 1, turned[j] + gap_rad);
    }
  }
  return compared;
}

IndexPairs tum_motions(const Trajectory& trajectory, const Delta& delta) {
  IndexPairs pairs;
  const std::vector<double> along = measured_along(trajectory, delta.unit);
  for (std::size_t i = 0; i < along.size(); ++i) {
    const std::size_t j = bisected(along, along[i] + delta.value);
    if (j + 1 != along.size()) pairs.emplace_back(i, j);
  }
  return pairs;
}

IndexPairs all_to_all(std::size_t poses) {
  IndexPairs pairs;
  pairs.reserve(poses * poses);
  for (std::size_t i = 0; i < poses; ++i) {
    for (std::size_t j = 0; j < poses; ++j) pairs.emplace_back(i, j);
  }
  return pairs;
}

IndexPairs rpg_motions(const Trajectory& trajectory, double length_m, bool as_published) {
  constexpr double kTolerance = 0.2;
  const std::vector<double> along = path_lengths(trajectory);
  IndexPairs pairs;
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double wanted = along[i] + length_m;
    const auto later = std::span(along).subspan(i);
    const auto miss = [&](auto place) { return std::abs(*place - wanted); };
    // Of paths that differ as little the script takes the first, and there the first pose.
    auto best = std::ranges::lower_bound(later, wanted);
    if (best == later.end() || (best != later.begin() && miss(best - 1) <= miss(best)))
      best = std::ranges::lower_bound(later.begin(), best, *(best - 1));
    if (miss(best) < kTolerance * length_m) {
      const std::size_t begin = as_published ? pairs.size() : i;
      pairs.emplace_back(begin, i + static_cast<std::size_t>(best - later.begin()));
    }
  }
  return pairs;
}

Result<void> check_delta(const Delta& delta) {
  const bool frames = delta.unit == DeltaUnit::frames;
  constexpr double kMost = 1e9;
  const bool forwards = delta.value >= (frames ? 1.0 : 0.0) && delta.value <= kMost;
  const bool whole = !frames || std::floor(delta.value) == delta.value;
  const bool half_turn = !is_angle(delta.unit) || in_radians(delta) <= std::numbers::pi;
  if (forwards && whole && half_turn) return {};
  return fail(ErrorCode::configuration,
              fmt::format("delta = {} {} (allowed: {})", delta.value, to_string(delta.unit),
                          frames                 ? "whole frames, 1 to 1e9"
                          : is_angle(delta.unit) ? "0 to 180 degrees"
                                                 : "0 to 1e9"));
}

}  // namespace fusebench::trajectory_error
