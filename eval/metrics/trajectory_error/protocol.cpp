#include "eval/metrics/trajectory_error/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace fusebench::trajectory_error {

namespace {

struct ProtocolRow {
  Protocol protocol;
  std::string_view name;
  std::string_view source;
  trajectory_files::AssociationRule association;
  double max_difference_s;
  AlignmentMode alignment;
  MotionRule motions;
  Delta delta;
};

constexpr double kLargestGapEth3d_s = 1.0 / 75.0;

constexpr std::array kProtocols{
    ProtocolRow{Protocol::evo,
                "evo",
                "evo v1.36.5",
                trajectory_files::AssociationRule::nearest,
                0.01,
                AlignmentMode::none,
                MotionRule::consecutive,
                {1, DeltaUnit::frames}},
    ProtocolRow{Protocol::tum,
                "tum",
                "evaluate_ate.py and evaluate_rpe.py of the TUM RGB-D benchmark",
                trajectory_files::AssociationRule::greedy,
                0.02,
                AlignmentMode::se3,
                MotionRule::fixed_delta,
                {1, DeltaUnit::seconds}},
    ProtocolRow{Protocol::rpg,
                "rpg",
                "rpg_trajectory_evaluation (Zhang & Scaramuzza, IROS 2018)",
                trajectory_files::AssociationRule::greedy,
                0.02,
                AlignmentMode::sim3,
                MotionRule::segments,
                {}},
    ProtocolRow{Protocol::eth3d,
                "eth3d",
                "ETH3D's SLAM evaluation program (Schoeps et al., CVPR 2019)",
                trajectory_files::AssociationRule::held,
                kLargestGapEth3d_s,
                AlignmentMode::se3,
                MotionRule::segments,
                {}},
    ProtocolRow{Protocol::kitti,
                "kitti",
                "KITTI's odometry benchmark (Geiger et al., CVPR 2012)",
                trajectory_files::AssociationRule::index,
                0.01,
                AlignmentMode::none,
                MotionRule::segments,
                {}},
};

const ProtocolRow& protocol_row(Protocol protocol) {
  return *std::ranges::find(kProtocols, protocol, &ProtocolRow::protocol);
}

}  // namespace

std::string_view to_string(Protocol protocol) { return protocol_row(protocol).name; }

std::string_view source_of(Protocol protocol) { return protocol_row(protocol).source; }

std::string_view to_string(TrajectoryMetric metric) {
  return metric == TrajectoryMetric::ate ? "ate" : "rpe";
}

std::string_view to_string(MotionRule rule) {
  switch (rule) {
    case MotionRule::consecutive:
      return "consecutive";
    case MotionRule::all:
      return "all";
    case MotionRule::fixed_delta:
      return "fixed delta";
    case MotionRule::each_to_each:
      return "each to each";
    case MotionRule::segments:
      return "segments";
  }
  return "";
}

Result<Protocol> parse_protocol(std::string_view text) {
  for (const ProtocolRow& row : kProtocols) {
    if (text == row.name) return row.protocol;
  }
  return fail(ErrorCode::usage, fmt::format("unknown protocol '{}'", text),
              "protocols are evo, tum, rpg, eth3d and kitti");
}

Result<TrajectoryRequest> request_for(Protocol protocol, TrajectoryMetric metric) {
  if (protocol == Protocol::kitti && metric == TrajectoryMetric::ate) {
    return fail(ErrorCode::usage, "KITTI's benchmark has no absolute error",
                "`--protocol evo --format kitti` computes one");
  }
  const ProtocolRow& row = protocol_row(protocol);
  TrajectoryRequest request;
  request.metric = metric;
  request.protocol = protocol;
  request.association.rule = row.association;
  request.association.max_difference_s = row.max_difference_s;
  // TUM's relative error aligns nothing.
  const bool tum_motions = protocol == Protocol::tum && metric == TrajectoryMetric::rpe;
  // It takes the ground truth within twice its median interval (see RpeOptions).
  if (tum_motions) request.association.max_difference_s = std::numeric_limits<double>::infinity();
  request.alignment.mode = tum_motions ? AlignmentMode::none : row.alignment;
  request.alignment.single_pose = protocol == Protocol::rpg;
  request.motions = row.motions;
  request.delta = row.delta;
  return request;
}

}  // namespace fusebench::trajectory_error
