#include "eval/cli/trajectories/option_effects.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <string_view>

namespace fusebench::cli::trajectories {

namespace {

using trajectory_error::AlignmentMode;
using trajectory_error::DeltaUnit;
using trajectory_error::MotionRule;
using trajectory_files::AssociationRule;

bool is_relative(const OptionContext& c) {
  return c.request.metric == trajectory_error::TrajectoryMetric::rpe;
}

/// Relative errors as evaluate_rpe.py computes them, from whole trajectories.
bool is_tum(const OptionContext& c) {
  return is_relative(c) &&
         (c.request.motions == MotionRule::fixed_delta || c.request.motions == MotionRule::each_to_each);
}

bool has_segments(const OptionContext& c) {
  return is_relative(c) && c.request.motions == MotionRule::segments;
}

/// Each error belongs to a pose that is drawn.
bool has_poses_of_errors(const OptionContext& c) { return c.draws && !is_tum(c) && !has_segments(c); }

bool has_stamps(const OptionContext& c) { return c.has_stamps; }
bool draws(const OptionContext& c) { return c.draws; }

bool has_difference(const OptionContext& c) {
  const bool held = c.request.association.rule == AssociationRule::held;
  return c.has_stamps && c.associates && (!held || !c.request.association.evaluated_ns.empty());
}

bool uses_images(const OptionContext& c) { return c.request.association.rule == AssociationRule::held; }

bool has_range(const OptionContext& c) { return c.has_stamps && !is_tum(c); }

bool is_aligned(const OptionContext& c) {
  const AlignmentMode mode = c.request.alignment.mode;
  return !is_tum(c) || mode == AlignmentMode::none || mode == AlignmentMode::sim3 ||
         mode == AlignmentMode::scale;
}

bool fits_alignment(const OptionContext& c) {
  const auto& alignment = c.request.alignment;
  const bool first_pose = alignment.mode == AlignmentMode::origin && !alignment.scale_origin;
  return alignment.mode != AlignmentMode::none && !first_pose;
}

bool is_projected(const OptionContext& c) {
  return c.request.plane == trajectory_error::Plane::none || (!is_tum(c) && !has_segments(c));
}

bool has_relation(const OptionContext& c) {
  const bool usual = c.request.relation == trajectory_error::PoseRelation::translation;
  return !has_segments(c) && (usual || !is_tum(c));
}

bool has_delta(const OptionContext& c) { return c.request.motions != MotionRule::each_to_each; }

bool has_tolerance(const OptionContext& c) {
  return c.request.motions == MotionRule::all && c.request.delta.unit != DeltaUnit::frames;
}

bool selects_motions(const OptionContext& c) {
  return !is_tum(c) && c.request.delta.unit != DeltaUnit::frames;
}

bool has_abscissa(const OptionContext& c) { return c.draws_over_distance ? has_poses_of_errors(c) : c.draws; }

bool draws_reference(const OptionContext& c) { return c.draws && !is_tum(c); }

struct OptionRow {
  const char* option;
  bool (*has_effect)(const OptionContext& context);
  const char* needs;
};

constexpr const char* kStamps = "it requires trajectories with stamps";
constexpr const char* kPlot = "it requires -p, --plot FILE or --save_plot FILE";
constexpr const char* kColours =
    "it requires -p, --plot FILE or --save_plot FILE, and errors of single poses: `eval ate`, or `eval rpe` "
    "with --protocol evo";
constexpr const char* kAssociated = "it requires `eval ate`, or `eval rpe` with --protocol evo";

constexpr std::array kRows{
    OptionRow{"--stamp_unit", has_stamps, kStamps},
    OptionRow{"--duplicates", has_stamps, kStamps},
    OptionRow{"--sync", has_stamps, kStamps},
    OptionRow{"--t_offset", has_stamps, kStamps},
    OptionRow{"--t_max_diff", has_difference,
              "it requires poses that are associated by stamps: of `eval traj` --sync or an alignment, of "
              "--protocol eth3d --images or --interpolate"},
    OptionRow{"--t_start", has_range,
              "it requires stamps, and is not part of evaluate_rpe.py: --protocol evo has it"},
    OptionRow{"--t_end", has_range,
              "it requires stamps, and is not part of evaluate_rpe.py: --protocol evo has it"},
    OptionRow{"--interpolate", [](const OptionContext& c) { return !is_tum(c); }, kAssociated},
    OptionRow{"--images", uses_images,
              "without --interpolate, --protocol eth3d compares at stamps of images"},
    OptionRow{"--align", is_aligned, "relative errors change with the scale only: --align sim3 or scale"},
    OptionRow{"-a", is_aligned, "relative errors change with the scale only: --align sim3 or scale"},
    OptionRow{"--align_origin", is_aligned, "relative errors change with the scale only: --align scale"},
    OptionRow{"--n_to_align", fits_alignment,
              "it requires an alignment from several poses, such as -a or --align sim3"},
    OptionRow{"--project_to_plane", is_projected, kAssociated},
    OptionRow{"--pose_relation", has_relation,
              "--protocol tum computes trans_part and angle_deg, rpg, eth3d and kitti errors of segments; "
              "--protocol evo computes any relation"},
    OptionRow{"--delta", has_delta, "with --protocol tum, --all_pairs compares all pairs of poses"},
    OptionRow{"--delta_unit", has_delta, "with --protocol tum, --all_pairs compares all pairs of poses"},
    OptionRow{"--delta_tol", has_tolerance, "it requires --all_pairs and --delta_unit m, d, r or s"},
    OptionRow{"--pairs_from_reference", selects_motions,
              "it requires --protocol evo and --delta_unit m, d, r or s"},
    OptionRow{"--plot_mode", draws, kPlot},
    OptionRow{"--plot_x_dimension", has_abscissa, kColours},
    OptionRow{"--plot_colormap_min", has_poses_of_errors, kColours},
    OptionRow{"--plot_colormap_max", has_poses_of_errors, kColours},
    OptionRow{"--plot_colormap_max_percentile", has_poses_of_errors, kColours},
    OptionRow{"--plot_full_ref", draws_reference, kPlot},
};

bool is_given(const CLI::App& verb, const char* name) {
  const CLI::Option* const option = verb.get_option_no_throw(name);
  return option != nullptr && option->count() > 0;
}

}  // namespace

Result<std::vector<std::string>> warnings_of_effects(const CLI::App& verb, const OptionContext& context) {
  const bool warns = context.has_stamps && context.request.protocol == trajectory_error::Protocol::evo;
  std::vector<std::string> warnings;
  for (const OptionRow& row : kRows) {
    if (!is_given(verb, row.option) || row.has_effect(context)) continue;
    std::string place = "`eval " + verb.get_name();
    if (verb.get_option_no_throw("--protocol") != nullptr)
      place += fmt::format(" --protocol {}", trajectory_error::to_string(context.request.protocol));
    std::string message = fmt::format("{} has no effect on this {}`", row.option, place);
    if (!warns) return fail(ErrorCode::usage, std::move(message), row.needs);
    warnings.push_back(fmt::format("{}: {}", message, row.needs));
  }
  return warnings;
}

}  // namespace fusebench::cli::trajectories
