#include "eval/imported_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "core/association.hpp"
#include "core/fingerprint.hpp"
#include "core/mesh_file.hpp"
#include "core/ply_file.hpp"
#include "core/staged_folder.hpp"
#include "core/trajectory_file.hpp"
#include "core/variants.hpp"
#include "eval/record_files.hpp"
#include "eval/record_origin.hpp"
#include "eval/run_evaluation.hpp"
#include "eval/trajectory/stamps.hpp"

namespace fusebench {

namespace {

constexpr std::int64_t kSameFrame_ns = 20'000'000;

Result<void> check_name(const std::string& name) {
  const bool letters = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == '+';
  });
  if (!letters || name.starts_with('.')) {
    return fail(ErrorCode::usage, fmt::format("'{}' is no name of a system", name),
                "letters, digits, '-', '_', '+' and '.', as in ORB-SLAM3");
  }
  const auto ours = std::ranges::find(all_variants(), name, [](const Variant& v) { return v.name; });
  if (ours == all_variants().end()) return {};
  return fail(ErrorCode::usage, fmt::format("{} is a variant of this program", name),
              "give the imported system a name of its own");
}

Result<Recording> open(const ImportSpec& spec) {
  auto recording = open_recording(spec.recording, spec.open);
  if (!recording) return recording;
  if (spec.frames) {
    if (auto cut = select_frames(*recording, spec.frames->begin, spec.frames->end); !cut)
      return tl::unexpected(cut.error());
  }
  if (recording->frames.empty())
    return fail(ErrorCode::data_corrupt, fmt::format("recording '{}' has no frames", recording->name));
  return recording;
}

/// Poses without stamps get those of the frames.
Result<Trajectory> stamped(LoadedTrajectory loaded, const Recording& recording) {
  if (loaded.has_stamps()) return std::move(loaded.poses);
  if (loaded.poses.size() != recording.frames.size()) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("{} poses without stamps for {} frames", loaded.poses.size(), recording.frames.size()),
        "a trajectory with stamps (TUM) may have gaps");
  }
  for (std::size_t i = 0; i < loaded.poses.size(); ++i)
    loaded.poses[i].timestamp_ns = recording.frames[i].timestamp_ns;
  return std::move(loaded.poses);
}

/// The poses of frames, with the instants that they are of.
struct OwnedPoses {
  Trajectory poses;
  std::vector<StampAndInstant> stamps;
};

Result<OwnedPoses> poses_of_frames(const Trajectory& poses, const Recording& recording) {
  std::vector<std::int64_t> frames_ns;
  for (const FrameEntry& frame : recording.frames) frames_ns.push_back(frame.timestamp_ns);
  OwnedPoses owned;
  for (const AssociatedPair& pair : associate(frames_ns, stamps_of(poses), kSameFrame_ns, 0)) {
    const FrameEntry& frame = recording.frames[pair.first];
    const StampedPose& pose = poses[pair.second];
    owned.poses.push_back(pose);
    // The frame's instant may differ from its stamp; the pose's differs as much.
    owned.stamps.emplace_back(pose.timestamp_ns, pose.timestamp_ns + frame.capture_ns - frame.timestamp_ns);
  }
  if (!owned.poses.empty()) return owned;
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("none of {} poses ({:.3f} to {:.3f} s) belongs to one of {} frames ({:.3f} to {:.3f} s)",
                  poses.size(), stamp_seconds(poses.front().timestamp_ns),
                  stamp_seconds(poses.back().timestamp_ns), frames_ns.size(),
                  stamp_seconds(frames_ns.front()), stamp_seconds(frames_ns.back())),
      "stamps must be those of the colour images, within 0.02 s");
}

RecordedMetrics metrics_of_import(const RunOutput& output, const Recording& recording,
                                  const Workers& workers) {
  RecordedMetrics metrics = metrics_of(output, recording, Config{}, workers);
  metrics.aie = {std::nullopt, "an imported run says nothing of intensities"};
  metrics.residuals = {std::nullopt, "an imported run says nothing of residuals"};
  metrics.nees.fill({std::nullopt, "an imported run has no covariance"});
  if (output.mesh.vertices.empty()) metrics.mesh = {std::nullopt, "no mesh was imported"};
  return metrics;
}

Result<std::string> hash_of(const ImportSpec& spec, TrajectoryFormat format, const Recording& recording) {
  Fingerprint identity;
  for (const auto& file : {spec.trajectory, spec.mesh}) {
    if (file.empty()) continue;
    if (auto added = identity.add_file(file); !added) return tl::unexpected(added.error());
  }
  identity.add(recording.fingerprint);
  identity.add(spec.imu);
  identity.add(to_string(format));
  const PinholeCamera& camera = recording.rig.camera;
  identity.add(fmt::format("{} {} {} {} {} {}", camera.width_px, camera.height_px, camera.fx_px, camera.fy_px,
                           camera.cx_px, camera.cy_px));
  return identity.hex();
}

Result<void> write(ImportedRun& run, const RunOutput& output, const Trajectory& truth) {
  auto folder = StagedFolder::create(run.folder);
  if (!folder) return tl::unexpected(folder.error());
  if (!output.mesh.vertices.empty()) {
    if (auto written = write_ply(output.mesh, folder->file("mesh.ply")); !written) return written;
  }
  const std::array<std::pair<std::string_view, std::string>, 3> texts = {
      {{"trajectory.tum", tum_text(output.trajectory)},
       {"truth.tum", tum_text(truth)},
       {"log.txt", fmt::format("imported: {} of {} frames have a pose\n", run.record.frames.tracked,
                               run.record.frames.total)}}};
  for (const auto& [name, text] : texts) {
    if (text.empty()) continue;  // no truth
    if (auto written = folder->write(name, text); !written) return written;
  }
  return commit_run(*folder, run.record);
}

}  // namespace

Result<ImportedRun> import_run(const ImportSpec& spec) {
  if (auto named = check_name(spec.name); !named) return tl::unexpected(named.error());
  const auto recording = open(spec);
  if (!recording) return tl::unexpected(recording.error());
  ImportedRun run;
  auto loaded = load_trajectory(spec.trajectory, spec.format, Duplicates::rare_last, run.warnings);
  if (!loaded) return tl::unexpected(loaded.error());
  const TrajectoryFormat format = loaded->format;
  const auto poses = stamped(std::move(*loaded), *recording);
  if (!poses) return tl::unexpected(poses.error());
  const auto owned = poses_of_frames(*poses, *recording);
  if (!owned) return tl::unexpected(owned.error());
  const auto hash = hash_of(spec, format, *recording);
  if (!hash) return tl::unexpected(hash.error());
  RunOutput output;
  output.trajectory = owned->poses;
  for (const auto& [stamp_ns, instant_ns] : owned->stamps) output.states.push_back({instant_ns, {}});
  if (!spec.mesh.empty()) {
    const auto mesh = read_mesh(spec.mesh);
    if (!mesh) return tl::unexpected(mesh.error());
    output.mesh = mesh->cast<float>();
    output.mesh.quality.clear();  // ours is the error of each vertex
  }

  RunRecord& record = run.record;
  record.status = RunStatus::ok;
  record.reason = "";
  record.recording = recorded_recording(*recording, spec.recording, spec.frames ? spec.frames->begin : 0);
  record.recording.imu = spec.imu;
  record.recording.imu_note = "";
  record.variant = spec.name;
  record.config_hash = *hash;
  record.frames.total = recording->frames.size();
  record.frames.tracked = owned->poses.size();
  record.frames.lost = record.frames.total - record.frames.tracked;
  record.model = {output.mesh.vertices.size(), output.mesh.triangles.size(), 0};
  record.metrics = metrics_of_import(output, *recording, Workers(spec.threads));
  if (record.metrics.mesh.value) {
    const auto& errors_m = record.metrics.mesh.value->vertex_errors_m;
    output.mesh.quality.assign(errors_m.begin(), errors_m.end());
  }
  record.provenance = provenance_here(spec.threads);
  run.folder = spec.out / recording->name / spec.name / hash->substr(0, 8);
  std::vector<StampAndInstant> stamps = frame_stamps(*recording);
  stamps.insert(stamps.end(), owned->stamps.begin(), owned->stamps.end());
  const std::set<StampAndInstant> in_order(stamps.begin(), stamps.end());
  stamps.assign(in_order.begin(), in_order.end());
  if (auto written = write(run, output, true_trajectory(*recording, stamps)); !written)
    return tl::unexpected(written.error());
  return run;
}

}  // namespace fusebench
