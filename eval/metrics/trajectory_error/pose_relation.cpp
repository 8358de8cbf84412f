#include "eval/metrics/trajectory_error/pose_relation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/nearest_name.hpp"

namespace fusebench::trajectory_error {

namespace {

struct Spelling {
  PoseRelation relation;
  std::string_view name;
  std::string_view unit;
};

constexpr std::array kSpellings{
    Spelling{PoseRelation::translation, "trans_part", "m"},
    Spelling{PoseRelation::point_distance, "point_distance", "m"},
    Spelling{PoseRelation::distance_error_ratio, "point_distance_error_ratio", "%"},
    Spelling{PoseRelation::rotation_part, "rot_part", ""},
    Spelling{PoseRelation::angle_rad, "angle_rad", "rad"},
    Spelling{PoseRelation::angle_deg, "angle_deg", "deg"},
    Spelling{PoseRelation::full, "full", ""},
};

const Spelling& spelling_of(PoseRelation relation) {
  for (const Spelling& spelling : kSpellings) {
    if (spelling.relation == relation) return spelling;
  }
  return kSpellings.front();
}

/// |R - I| of an angle: each of the two planes' four entries move by 2 sin(angle / 2) in all.
double rotation_part(double angle_rad) { return 2.0 * std::numbers::sqrt2 * std::sin(0.5 * angle_rad); }

double of_difference(PoseRelation relation, const SE3& difference) {
  const double angle_rad = so3_log(difference.rotation).norm();
  switch (relation) {
    case PoseRelation::rotation_part:
      return rotation_part(angle_rad);
    case PoseRelation::angle_rad:
      return angle_rad;
    case PoseRelation::angle_deg:
      return degrees(angle_rad);
    case PoseRelation::full:
      return std::hypot(rotation_part(angle_rad), difference.translation.norm());
    case PoseRelation::translation:
    case PoseRelation::point_distance:
    case PoseRelation::distance_error_ratio:
      break;
  }
  return difference.translation.norm();
}

}  // namespace

std::string_view to_string(PoseRelation relation) { return spelling_of(relation).name; }

std::string_view unit_of(PoseRelation relation) { return spelling_of(relation).unit; }

Result<PoseRelation> parse_pose_relation(std::string_view text) {
  std::vector<std::string_view> names;
  for (const Spelling& spelling : kSpellings) {
    if (spelling.name == text) return spelling.relation;
    names.push_back(spelling.name);
  }
  return fail(ErrorCode::usage, fmt::format("unknown pose relation '{}'{}", text, nearest_hint(text, names)),
              fmt::format("pose relations are {}", fmt::join(names, ", ")));
}

double absolute_error(PoseRelation relation, const SE3& reference, const SE3& estimate) {
  check(relation != PoseRelation::distance_error_ratio, "a ratio of distances is of motions");
  if (relation == PoseRelation::translation || relation == PoseRelation::point_distance)
    return (estimate.translation - reference.translation).norm();
  return of_difference(relation, motion_between(estimate, reference));
}

std::optional<double> relative_error(PoseRelation relation, const Motion& reference, const Motion& estimate) {
  if (relation == PoseRelation::point_distance || relation == PoseRelation::distance_error_ratio) {
    const double moved_m = (reference.to.translation - reference.from.translation).norm();
    const double error_m = std::abs(moved_m - (estimate.to.translation - estimate.from.translation).norm());
    if (relation == PoseRelation::point_distance) return error_m;
    if (!(moved_m > 0)) return std::nullopt;
    return 100.0 * error_m / moved_m;
  }
  const SE3 reference_motion = motion_between(reference.from, reference.to);
  const SE3 estimate_motion = motion_between(estimate.from, estimate.to);
  return of_difference(relation, motion_between(reference_motion, estimate_motion));
}

}  // namespace fusebench::trajectory_error
