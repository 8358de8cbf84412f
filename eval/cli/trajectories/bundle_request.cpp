#include "eval/cli/trajectories/bundle_request.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/cli/trajectories/trajectory_request.hpp"
#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/trajectory_error/trajectory_error.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::trajectories {

namespace {

/// The estimate's is that of all files but the reference.
Result<SideReadings> readings_of(const BundleOptions& options) {
  trajectory_files::TrajectoryReading reading;
  reading.duplicates = trajectory::Duplicates::as_written;  // a look at the file as it is
  if (!options.format.empty()) {
    const auto format = trajectory_files::parse_trajectory_format(options.format);
    if (!format) return tl::unexpected(format.error());
    reading.format = *format;
  }
  SideReadings readings{reading, reading};
  if (auto set = set_stamp_units(options.stamp_unit, readings); !set) return tl::unexpected(set.error());
  return readings;
}

Result<NamedFile> load(const std::string& file, const BundleOptions& options,
                       const trajectory_files::TrajectoryReading& reading, Transcript& transcript) {
  std::vector<std::string> warnings;
  auto loaded = trajectory_files::load_trajectory(file, reading, warnings);
  if (!loaded) return tl::unexpected(loaded.error());
  transcript.warn(warnings);
  const std::string name = options.full_names ? file : std::filesystem::path(file).stem().string();
  const bool has_stamps = loaded->has_stamps();
  const std::string format(trajectory_files::to_string(loaded->format));
  Trajectory poses = std::move(loaded->poses);
  if (options.downsample > 0) poses = trajectory_error::downsampled(poses, options.downsample);
  if (!options.motion_filter.empty())
    poses = trajectory_error::moved_only(poses, options.motion_filter[0], radians(options.motion_filter[1]));
  return NamedFile{file,
                   {name, std::move(poses), has_stamps, format, loaded->format_source, std::move(warnings)}};
}

Result<Bundle> load_all(const BundleOptions& options, Transcript& transcript) {
  const auto readings = readings_of(options);
  if (!readings) return tl::unexpected(readings.error());
  std::vector<std::string> files;
  for (const std::string& file : options.files) {
    if (file != options.reference) files.push_back(file);
  }
  if (!options.reference.empty()) files.push_back(options.reference);
  Bundle bundle;
  bundle.has_reference = !options.reference.empty();
  for (const std::string& file : files) {
    const bool is_reference = file == options.reference;
    auto loaded = load(file, options, is_reference ? readings->reference : readings->estimate, transcript);
    if (!loaded) return tl::unexpected(loaded.error());
    bundle.trajectories.push_back(std::move(*loaded));
  }
  bundle.has_stamps = bundle.trajectories.front().trajectory.has_stamps;
  for (const NamedFile& entry : bundle.trajectories) {
    if (entry.trajectory.has_stamps == bundle.has_stamps) continue;
    return fail(ErrorCode::usage,
                fmt::format("{} has {}stamps, {} has {}", entry.file, bundle.has_stamps ? "no " : "",
                            bundle.trajectories.front().file, bundle.has_stamps ? "some" : "none"),
                "use trajectories with stamps, or trajectories without (kitti)");
  }
  return bundle;
}

Result<void> check_reference(const BundleOptions& options, const Bundle& bundle) {
  if ((options.alignment.asked() || options.sync) && !bundle.has_reference)
    return fail(ErrorCode::usage,
                fmt::format("{} needs a reference", options.sync ? "--sync" : "an alignment"),
                "--ref FILE names it");
  if (options.fit_time_offset && !bundle.has_reference)
    return fail(ErrorCode::usage, "--fit-time-offset needs a reference", "--ref FILE names it");
  if (options.fit_time_offset && !bundle.has_stamps)
    return fail(ErrorCode::usage, "--fit-time-offset: the trajectories have no stamps (kitti)");
  if (options.t_offset != 0 && !bundle.has_stamps)
    return fail(ErrorCode::usage, "--t_offset of trajectories without stamps (kitti)");
  return {};
}

/// Associates with the reference if requested, aligns and projects.
Result<Trajectory> brought_to(const Trajectory& reference, const Trajectory& poses,
                              const BundleOptions& options, bool has_stamps) {
  const auto alignment = aligned_by(options.alignment, {});
  if (!alignment) return tl::unexpected(alignment.error());
  trajectory_files::AssociationOptions association;
  association.max_difference_s = options.t_max_diff;
  if (!has_stamps) association.rule = trajectory_files::AssociationRule::index;
  const auto pair = trajectory_files::pair_up(reference, poses, association);
  if (!pair) return tl::unexpected(pair.error());
  auto compared = trajectory_error::absolute_error(
      *pair, {trajectory_error::PoseRelation::translation, *alignment, named(kPlanes, options.plane), true});
  if (!compared) return tl::unexpected(compared.error());
  return std::move(compared->compared.estimate);
}

/// Moves the stamps of a trajectory to the reference's clock by the fitted offset, and keeps that.
Result<void> move_to_clock(const Trajectory& reference, metric_reports::ListedTrajectory& listed) {
  auto clock = reference_clock::fitted_reference_clock(reference, listed.poses);
  if (!clock) return tl::unexpected(clock.error());
  clock->applied = true;
  listed.poses = trajectory::with_clock_offset(std::move(listed.poses),
                                               trajectory_files::nanoseconds(clock->offset.offset_s));
  listed.clock = *clock;
  return {};
}

/// Against itself, pose by pose: projected and nothing else.
Result<Trajectory> projected(Trajectory poses, const BundleOptions& options) {
  trajectory_files::TrajectoryPair pair;
  pair.reference = poses;
  pair.estimate = std::move(poses);
  auto compared = trajectory_error::absolute_error(
      pair, {trajectory_error::PoseRelation::translation, {}, named(kPlanes, options.plane), true});
  if (!compared) return tl::unexpected(compared.error());
  return std::move(compared->compared.estimate);
}

}  // namespace

Result<Bundle> bundle_of(const BundleOptions& options, Transcript& transcript) {
  auto bundle = load_all(options, transcript);
  if (!bundle) return bundle;
  if (auto checked = check_reference(options, *bundle); !checked) return tl::unexpected(checked.error());
  const std::size_t others = bundle->trajectories.size() - (bundle->has_reference ? 1 : 0);
  const bool associated = options.alignment.asked() || (options.sync && bundle->has_stamps);
  for (std::size_t i = 0; i < bundle->trajectories.size(); ++i) {
    NamedFile& entry = bundle->trajectories[i];
    Trajectory& poses = entry.trajectory.poses;
    const auto in_file = [&](const Error& error) {
      return fail(error.code, fmt::format("{}: {}", entry.file, error.message), error.hint);
    };
    if (i < others && options.t_offset != 0)
      poses = trajectory::with_clock_offset(std::move(poses), std::llround(1e9 * options.t_offset));
    const Trajectory& reference = bundle->trajectories.back().trajectory.poses;
    if (i < others && options.fit_time_offset) {
      if (auto moved = move_to_clock(reference, entry.trajectory); !moved) return in_file(moved.error());
    }
    auto brought = i < others && associated ? brought_to(reference, poses, options, bundle->has_stamps)
                                            : projected(std::move(poses), options);
    if (!brought) return in_file(brought.error());
    poses = std::move(*brought);
  }
  return bundle;
}

Result<void> save_bundle(const BundleOptions& options, const Bundle& bundle, Transcript& transcript) {
  std::vector<std::pair<std::filesystem::path, std::string>> outputs;
  std::set<std::filesystem::path> taken;
  for (const auto& [wanted, ending] :
       {std::pair{options.save_as_tum, ".tum"}, {options.save_as_kitti, ".kitti"}}) {
    if (!wanted) continue;
    const bool tum = std::string_view(ending) == ".tum";
    for (const NamedFile& entry : bundle.trajectories) {
      const std::filesystem::path file = std::filesystem::path(entry.file).stem().string() + ending;
      std::error_code ignored;
      if (tum && !entry.trajectory.has_stamps)
        return fail(ErrorCode::usage, fmt::format("--save_as_tum: {} has no stamps", entry.file),
                    "--save_as_kitti needs none");
      if (!taken.insert(file).second)
        return fail(ErrorCode::usage, fmt::format("two trajectories would be written into {}", file.string()),
                    "give their files different names, or save them one by one");
      if (std::filesystem::equivalent(file, entry.file, ignored))
        return fail(ErrorCode::usage, fmt::format("{} would be replaced by its own result", entry.file),
                    "run it in another folder: results go into the current one");
      outputs.emplace_back(file, tum ? trajectory::tum_text(entry.trajectory.poses)
                                     : trajectory_files::kitti_text(entry.trajectory.poses));
    }
  }
  for (const auto& [file, content] : outputs) {
    if (auto written = text::write_text_file(file, content); !written) return written;
    transcript.note(file.string() + ": written");
  }
  return {};
}

}  // namespace fusebench::cli::trajectories
