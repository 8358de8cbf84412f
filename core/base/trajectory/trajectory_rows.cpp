#include "core/base/trajectory/trajectory_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fusebench::trajectory {

namespace {

constexpr double kMinQuaternionNorm = 1e-3;  // below it four printed decimals do not determine a rotation
constexpr double kMaxNormError = 1e-3;       // ten times what rounding to four decimals does

struct BackwardSteps {
  std::size_t count = 0;
  std::size_t first = 0;  ///< the pose that lies before its predecessor in time
  double largest_s = 0;
};

BackwardSteps backward_steps(const Trajectory& poses) {
  BackwardSteps steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double back_s = seconds_between(poses[i].timestamp_ns, poses[i - 1].timestamp_ns);
    if (back_s <= 0) continue;
    if (steps.count++ == 0) steps.first = i;
    steps.largest_s = std::max(steps.largest_s, back_s);
  }
  return steps;
}

/// Sorting would interleave two concatenated trajectories.
Result<void> check_single(const TrajectoryRows& rows, const std::filesystem::path& file) {
  constexpr std::size_t kFewSteps = 3;
  const BackwardSteps steps = backward_steps(rows.poses);
  if (steps.count == 0 || steps.count > kFewSteps || rows.poses.size() < 10 * steps.count) return {};
  const auto [earliest, latest] =
      std::ranges::minmax_element(rows.poses, {}, [](const StampedPose& pose) { return pose.timestamp_ns; });
  if (steps.largest_s < 0.5 * seconds_between(earliest->timestamp_ns, latest->timestamp_ns)) return {};
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}:{}: time jumps back by {:.3f} s: the file seems to hold {} trajectories, one "
                          "after the other",
                          file.string(), rows.lines[steps.first], steps.largest_s, steps.count + 1),
              "split the file there");
}

/// Numbers of the rows by time; rows of one stamp in the order of the file.
std::vector<std::size_t> by_time(const Trajectory& poses) {
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return poses[i].timestamp_ns; });
  return order;
}

/// Rows whose stamp an earlier row has, and the first of them.
struct Repeats {
  std::size_t count = 0;
  int line = 0;
  int earlier_line = 0;
};

Repeats repeats_of(const TrajectoryRows& rows, const std::vector<std::size_t>& order) {
  Repeats repeats;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (rows.poses[order[k]].timestamp_ns != rows.poses[order[k - 1]].timestamp_ns) continue;
    if (repeats.count++ > 0) continue;
    repeats.line = rows.lines[order[k]];
    repeats.earlier_line = rows.lines[order[k - 1]];
  }
  return repeats;
}

bool allows(Duplicates duplicates, std::size_t repeats, std::size_t rows) {
  constexpr std::size_t kRare = 100;  // rows for one repeat
  if (duplicates == Duplicates::none) return repeats == 0;
  const bool rare_only = duplicates == Duplicates::rare_last || duplicates == Duplicates::rare_kept;
  return !rare_only || repeats * kRare <= rows;
}

}  // namespace

io::TimeOrder order_for(Duplicates duplicates) {
  switch (duplicates) {
    case Duplicates::error:
      return io::TimeOrder::increasing;
    case Duplicates::last_in_order:
      return io::TimeOrder::not_backwards;
    case Duplicates::none:
    case Duplicates::first:
    case Duplicates::last:
    case Duplicates::as_written:
    case Duplicates::rare_last:
    case Duplicates::rare_kept:
      break;
  }
  return io::TimeOrder::any;
}

std::optional<std::string> coordinate_fault(std::string_view name, const Vector3d& position) {
  if (position.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMostPosition) return std::nullopt;
  return fmt::format("{} {:g} {:g} {:g} (allowed: coordinates up to {:g})", name, position.x(), position.y(),
                     position.z(), kMostPosition);
}

Result<void> check_position(const io::TextTable& table, const Vector3d& position) {
  if (const auto fault = coordinate_fault("position", position)) return table.fail_here(*fault);
  return {};
}

Result<void> take_pose(const io::TextTable& table, std::int64_t time_ns, const Vector3d& translation_m,
                       const Quaterniond& rotation, TrajectoryRows& rows) {
  const double norm = rotation.norm();
  if (!(norm > kMinQuaternionNorm && std::isfinite(norm))) {
    return table.fail_here(
        fmt::format("quaternion (x y z w) = {:g} {:g} {:g} {:g} has norm {:g} (expected 1)", rotation.x(),
                    rotation.y(), rotation.z(), rotation.w(), norm));
  }
  if (auto within = check_position(table, translation_m); !within) return within;
  if (std::abs(norm - 1.0) > kMaxNormError && rows.not_unit++ == 0) rows.first_not_unit_line = table.line();
  rows.poses.push_back({time_ns, {rotation.normalized(), translation_m}});
  rows.lines.push_back(table.line());
  return {};
}

Result<Trajectory> ordered(TrajectoryRows rows, Duplicates duplicates, const std::filesystem::path& file,
                           std::vector<std::string>& warnings) {
  if (rows.not_unit > 0) {
    warnings.push_back(
        fmt::format("{}:{}: {} of {} quaternions are off unit length by more than 0.1 % (normalised)",
                    file.string(), rows.first_not_unit_line, rows.not_unit, rows.poses.size()));
  }
  if (duplicates == Duplicates::error) return std::move(rows.poses);
  const bool sorted = std::ranges::is_sorted(rows.poses, {}, &StampedPose::timestamp_ns);
  if (duplicates == Duplicates::as_written) {
    if (!sorted)
      warnings.push_back(fmt::format("{}: rows are not in order of time (left as they are)", file.string()));
    return std::move(rows.poses);
  }
  if (auto single = check_single(rows, file); !single) return tl::unexpected(single.error());

  const std::vector<std::size_t> order = by_time(rows.poses);
  const Repeats repeats = repeats_of(rows, order);
  if (!allows(duplicates, repeats.count, rows.poses.size())) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{}:{}: the stamp is the same as that of line {} ({} of {} rows repeat a stamp)",
                    file.string(), repeats.line, repeats.earlier_line, repeats.count, rows.poses.size()),
        "remove one of the two rows, or say which one counts (--duplicates first or last; keep takes "
        "both, as evo does)");
  }
  Trajectory kept;
  kept.reserve(rows.poses.size());
  for (const std::size_t i : order) {
    const bool repeated = !kept.empty() && kept.back().timestamp_ns == rows.poses[i].timestamp_ns;
    if (!repeated || duplicates == Duplicates::rare_kept) {
      kept.push_back(rows.poses[i]);
    } else if (duplicates != Duplicates::first) {
      kept.back() = rows.poses[i];
    }
  }
  const std::string disorder = sorted ? "" : "rows are not in order of time (sorted)";
  const std::string_view which = duplicates == Duplicates::first       ? "the first one is kept"
                                 : duplicates == Duplicates::rare_kept ? "both are kept"
                                                                       : "the last one is kept";
  if (repeats.count > 0) {
    warnings.push_back(fmt::format("{}:{}: {}{}{} of {} rows repeat a stamp ({})", file.string(),
                                   repeats.line, disorder, sorted ? "" : "; ", repeats.count,
                                   rows.poses.size(), which));
  } else if (!sorted) {
    warnings.push_back(fmt::format("{}: {}", file.string(), disorder));
  }
  return kept;
}

}  // namespace fusebench::trajectory
