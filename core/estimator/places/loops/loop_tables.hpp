// Tables of loop candidates and places in CSV.
#pragma once

#include <string>

#include "core/estimator/places/loops/loop_closure.hpp"

namespace fusebench::loops {

/// One line for each candidate, after a header: stamps of both frames [s]; pose of the query camera in that
/// of the place (tx ty tz [m], qx qy qz qw) and its standard deviations by axis (rotation [rad], position
/// [m]), identity and 0 if there is none; dissimilarity, matches, inliers, shares of depth that is consistent
/// and in free space, squared distance to the current poses, verification ("features", "depth" or "nothing"),
/// "accepted" or "refused", and the reason. Empty without candidates.
[[nodiscard]] std::string candidate_table(const LoopClosure& closure);

/// One line for each place, after a header: stamp [s], motion blur [px], number of candidates, number of
/// accepted candidates. Empty without places.
[[nodiscard]] std::string place_table(const LoopClosure& closure);

}  // namespace fusebench::loops
