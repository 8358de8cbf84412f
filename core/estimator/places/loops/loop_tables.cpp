#include "core/estimator/places/loops/loop_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace fusebench::loops {

namespace {

constexpr std::string_view kCandidateHeader =
    "query_s,place_s,tx_m,ty_m,tz_m,qx,qy,qz,qw,sigma_rotation_rad,sigma_position_m,dissimilarity,matches,"
    "inliers,consistent_share,violating_share,chi2,verified_by,decision,why\n";
constexpr std::string_view kPlaceHeader = "timestamp_s,blur_px,candidates,accepted\n";

double seconds_of(const Place& place) { return 1e-9 * static_cast<double>(place.timestamp_ns); }

std::string_view verified_by(const LoopCandidate& candidate) {
  const places::VerifiedPair& pair = candidate.pair;
  if (!pair.same) return "nothing";
  if (candidate.evidence == LoopEvidence::tracker_alone) return "tracker";
  return pair.by_depth_alone ? "depth" : "features";
}

std::string candidate_row(const LoopClosure& closure, const LoopCandidate& candidate) {
  const places::VerifiedPair& pair = candidate.pair;
  const Vector3d& t = pair.T_known_query.translation;
  const Quaterniond& q = pair.T_known_query.rotation;
  Vector6d variances = Vector6d::Zero();
  if (pair.same) variances = closure.covariance_of(candidate).diagonal();
  std::string row = fmt::format("{:.6f},{:.6f},{:.6g},{:.6g},{:.6g},{:.8g},{:.8g},{:.8g},{:.8g},",
                                seconds_of(closure.places()[candidate.query]),
                                seconds_of(closure.places()[candidate.known]), t.x(), t.y(), t.z(), q.x(),
                                q.y(), q.z(), q.w());
  row += fmt::format("{:.3g},{:.3g},{:.3f},{},{},{:.3f},{:.3f},{:.4g},{},{},\"{}\"\n",
                     std::sqrt(variances.head<3>().mean()), std::sqrt(variances.tail<3>().mean()),
                     candidate.dissimilarity, pair.matches, pair.inliers, pair.consistent_share,
                     pair.violating_share, candidate.chi2, verified_by(candidate),
                     candidate.accepted ? "accepted" : "refused", candidate.verdict);
  return row;
}

}  // namespace

std::string candidate_table(const LoopClosure& closure) {
  if (closure.candidates().empty()) return {};
  std::string text(kCandidateHeader);
  for (const LoopCandidate& candidate : closure.candidates()) text += candidate_row(closure, candidate);
  return text;
}

std::string place_table(const LoopClosure& closure) {
  if (closure.places().empty()) return {};
  struct Counts {
    int candidates = 0, accepted = 0;
  };
  std::vector<Counts> counts(closure.places().size());
  for (const LoopCandidate& candidate : closure.candidates()) {
    ++counts[candidate.query].candidates;
    counts[candidate.query].accepted += candidate.accepted ? 1 : 0;
  }
  std::string text(kPlaceHeader);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Place& place = closure.places()[i];
    text += fmt::format("{:.6f},{:.3f},{},{}\n", seconds_of(place), place.blur_px, counts[i].candidates,
                        counts[i].accepted);
  }
  return text;
}

}  // namespace fusebench::loops
