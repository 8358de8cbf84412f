// What was looked at for loops, as CSV.
#pragma once

#include <string>

#include "core/loops/loop_closure.hpp"

namespace fusebench::loops {

/// A candidate a line, after a header: stamps of both frames [s]; pose of the query's camera in that of the
/// place (tx ty tz [m], qx qy qz qw) and its standard deviations by axis (rotation [rad], position [m]),
/// identity and 0 where there is none; dissimilarity, matches, inliers, shares of depth that is consistent
/// and in free space, squared distance to the poses so far, what verified the pair ("features", "depth" or
/// "nothing"), "accepted" or "refused", and why. Empty without a candidate.
[[nodiscard]] std::string candidate_table(const LoopClosure& closure);

/// A place a line, after a header: stamp [s], motion blur [px], how many candidates it was compared with, and
/// how many of these were accepted. Empty without a place.
[[nodiscard]] std::string place_table(const LoopClosure& closure);

}  // namespace fusebench::loops
