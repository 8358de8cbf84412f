// Which motions of a trajectory a relative error is taken over: pairs of poses a delta apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory_error {

enum class DeltaUnit { frames, metres, degrees, radians, seconds };
/// "f", "m", "d", "r", "s".
[[nodiscard]] std::string_view to_string(DeltaUnit unit);
/// The letters, or TUM's "rad" and "deg".
[[nodiscard]] Result<DeltaUnit> parse_delta_unit(std::string_view text);

struct Delta {
  double value = 1;  ///< in its unit; whole for frames
  DeltaUnit unit = DeltaUnit::frames;
};

/// Indices (i, j), i before j but for the all-to-all pairs of TUM's script.
using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;
using MotionVisitor = std::function<void(std::size_t i, std::size_t j)>;

/// Up to how many motions are held as a list, which takes about 75 bytes each until they are written. Of
/// more, errors are computed again for each pass over them (see streamed_statistics()).
struct MotionListing {
  std::size_t most = std::size_t{1} << 22;
  bool needed = false;                               ///< somebody wants to see each error: more are refused
  std::size_t most_compared = std::size_t{1} << 28;  ///< pairs of poses to look at, which takes minutes
};
/// Error usage: so many pairs of poses would have to be checked.
[[nodiscard]] Result<void> check_compared(const MotionListing& listing, std::size_t compared);
/// Error usage: a list is needed and would be too long.
[[nodiscard]] Result<void> check_listing(const MotionListing& listing, std::size_t motions);

/// Consecutive motions, one begins where the last one ended, as evo v1.36.5 selects them (its filters.py):
///   frames   poses 0, d, 2 d, ...
///   metres   marks where the path since the last mark reaches d; the first pose is no mark (but of d = 0)
///   degrees, radians   the sum of angles from pose to pose reaches d, from the first pose on
///   seconds  (ours) the first pose at least d later, from the first pose on
[[nodiscard]] IndexPairs consecutive_motions(const Trajectory& trajectory, const Delta& delta);

/// Motions from every pose, as evo's --all_pairs:
///   frames   (i, i + d)
///   metres   of all later poses that whose path from i is nearest d, the earliest of equally near ones; none
///            if it is further than tolerance * d from d
///   degrees, radians   every later pose whose direct angle to i is within tolerance * d of d
///   seconds  (ours) as metres
[[nodiscard]] IndexPairs all_motions(const Trajectory& trajectory, const Delta& delta, double tolerance);

/// all_motions() of degrees or radians one by one, in their order, without a list of them. Returns how many
/// pairs of poses were compared for that; ends before the motions do where these are more than most_compared.
std::size_t visit_turns(const Trajectory& trajectory, const Delta& delta, double tolerance,
                        std::size_t most_compared, const MotionVisitor& visit);

[[nodiscard]] bool is_angle(DeltaUnit unit);  ///< degrees or radians

/// As `evaluate_rpe.py --fixed_delta`: for each pose that whose index, time, path or summed angle along the
/// trajectory is found nearest to its own plus delta; pairs that end at the last pose are left out.
[[nodiscard]] IndexPairs tum_motions(const Trajectory& trajectory, const Delta& delta);

/// As `evaluate_rpe.py --max_pairs 0`: every pose with every pose, itself included. O(n^2)
[[nodiscard]] IndexPairs all_to_all(std::size_t poses);

/// As rpg_trajectory_evaluation: for each pose the later one whose path differs least from length_m, by less
/// than a fifth of it. The script drops poses without a partner from the list and then counts the rest from
/// the first pose on, so that behind a gap motions begin at earlier poses than they should; `as_published`
/// keeps that.
[[nodiscard]] IndexPairs rpg_motions(const Trajectory& trajectory, double length_m, bool as_published);

/// Path from the first pose to each (metres).
[[nodiscard]] std::vector<double> path_lengths(const Trajectory& trajectory);

/// Error configuration: a negative delta or more than 1e9, frames that are not whole or none, more than half
/// a turn.
[[nodiscard]] Result<void> check_delta(const Delta& delta);

}  // namespace fusebench::trajectory_error
