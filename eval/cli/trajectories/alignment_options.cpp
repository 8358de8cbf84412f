#include "eval/cli/trajectories/alignment_options.hpp"

#include <CLI/CLI.hpp>

#include "eval/cli/console/number_checks.hpp"

namespace fusebench::cli::trajectories {

void add_alignment_options(CLI::App& verb, AlignmentOptions& options) {
  verb.add_option(
          "--align", options.mode,
          "Alignment of the estimate: none, se3, sim3, scale, yaw (and position) or origin; without MODE as "
          "-a")
      ->type_name("MODE")
      ->check(CLI::IsMember(names_of(kAlignments)));
  verb.add_flag("-a", options.evo_align, "As --align se3");
  verb.add_flag("-s,--correct_scale", options.evo_scale, "As --align scale; -as as --align sim3");
  verb.add_flag("--align_origin", options.evo_origin, "As --align origin");
  verb.add_option("--n_to_align", options.n_to_align, "Computes the alignment from the first N pairs only")
      ->check(console::positive())
      ->type_name("N");
}

Result<trajectory_error::AlignmentRequest> aligned_by(const AlignmentOptions& options,
                                                      trajectory_error::AlignmentRequest usual) {
  const bool evo = options.evo_align || options.evo_scale || options.evo_origin;
  if (!options.mode.empty() && evo)
    return fail(ErrorCode::usage, "--align MODE and evo's -a, -s or --align_origin exclude each other");
  if (options.evo_align && options.evo_origin)
    return fail(ErrorCode::usage, "-a and --align_origin exclude each other");
  trajectory_error::AlignmentRequest request = usual;
  if (!options.mode.empty()) request.mode = named(kAlignments, options.mode);
  if (options.evo_align)
    request.mode =
        options.evo_scale ? trajectory_error::AlignmentMode::sim3 : trajectory_error::AlignmentMode::se3;
  if (options.evo_scale && !options.evo_align) request.mode = trajectory_error::AlignmentMode::scale;
  if (options.evo_origin) {
    request.mode = trajectory_error::AlignmentMode::origin;
    request.scale_origin = options.evo_scale;
  }
  request.first = options.n_to_align;
  return request;
}

}  // namespace fusebench::cli::trajectories
