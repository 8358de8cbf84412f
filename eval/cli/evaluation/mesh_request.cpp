#include "eval/cli/evaluation/mesh_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "datasets/open_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/metrics/mesh_error/transform_file.hpp"
#include "eval/metrics/trajectory_error/pose_alignment.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"
#include "eval/metrics/trajectory_files/trajectory_pair.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::cli::evaluation {

namespace {

Result<mesh_error::MeshSampling> sampling_of(const MeshVerbOptions& options) {
  if (options.samples == "vertices" && options.seed)
    return fail(ErrorCode::usage, "--seed has no effect with --samples vertices",
                "--samples N draws N points over the area by it");
  if (options.samples == "vertices") return mesh_error::MeshSampling{mesh_error::MeshSamples::vertices, 0, 0};
  mesh_error::MeshSampling sampling{mesh_error::MeshSamples::area, 0, options.seed.value_or(1)};
  const char* const end = options.samples.data() + options.samples.size();
  const auto [stop, status] = std::from_chars(options.samples.data(), end, sampling.count);
  constexpr std::size_t kMost = 100'000'000;
  if (status != std::errc{} || stop != end || sampling.count < 1 || sampling.count > kMost) {
    return fail(ErrorCode::usage,
                fmt::format("--samples {} (allowed: vertices, or 1 .. {})", options.samples, kMost));
  }
  return sampling;
}

/// What moves the reconstruction so that its cameras come to the true ones.
Result<SE3> alignment_of_trajectories(const std::vector<std::filesystem::path>& files) {
  const auto sides = trajectories::load_sides(files[0], files[1]);
  if (!sides) return tl::unexpected(sides.error());
  constexpr double kMaxGap_s = 0.1;
  const auto pair = trajectory_files::pair_up(
      sides->reference.poses, sides->estimate.poses,
      {sides->have_stamps() ? trajectory_files::AssociationRule::interpolated : sides->rule_without_stamps(),
       kMaxGap_s});
  if (!pair) return tl::unexpected(pair.error());
  std::vector<SE3> T_truth_camera;
  std::vector<SE3> T_estimate_camera;
  for (std::size_t i = 0; i < pair->size(); ++i) {
    T_truth_camera.push_back(pair->reference[i].T_world_camera);
    T_estimate_camera.push_back(pair->estimate[i].T_world_camera);
  }
  return trajectory_error::align_poses(T_truth_camera, T_estimate_camera);
}

Result<void> set_alignment(const MeshVerbOptions& options, mesh_error::MeshRequest& request) {
  const bool file = !options.transform.empty();
  const bool trajectories = !options.trajectories.empty();
  if (file && trajectories)
    return fail(ErrorCode::usage, "--transform and --trajectories exclude each other");
  if (options.align == "none" && (file || trajectories)) {
    return fail(
        ErrorCode::usage,
        fmt::format("--align none does not use {}", file ? "--transform" : "--trajectories"),
        fmt::format("--align {} does, and --align icp starts from there", file ? "file" : "trajectory"));
  }
  if (options.align == "file" && !file)
    return fail(ErrorCode::usage, "--align file requires --transform FILE");
  if (options.align == "trajectory" && !trajectories)
    return fail(ErrorCode::usage, "--align trajectory requires --trajectories TRUTH ESTIMATE");
  if (file || trajectories) {
    const auto start = file ? mesh_error::read_transform(options.transform)
                            : alignment_of_trajectories(options.trajectories);
    if (!start) return tl::unexpected(start.error());
    request.start = {file ? "file" : "trajectory", *start};
  }
  if (options.align == "icp")
    request.icp = mesh_error::RegistrationOptions{
        .kept = options.icp_kept.value_or(mesh_error::RegistrationOptions{}.kept)};
  if (options.icp_kept && !request.icp) return fail(ErrorCode::usage, "--icp-kept requires --align icp");
  return {};
}

mesh_error::Culling culling_of(const std::string& name) {
  for (const mesh_error::Culling culling : {mesh_error::Culling::frustum, mesh_error::Culling::occlusion}) {
    if (name == mesh_error::to_string(culling)) return culling;
  }
  return mesh_error::Culling::depth;  // the parser lets no other name through
}

Result<void> set_views(const MeshVerbOptions& options, mesh_error::MeshRequest& request) {
  const bool culls = options.cull != "none";
  if (culls != !options.recording.empty()) {
    return fail(ErrorCode::usage, culls ? fmt::format("--cull {} requires --recording REC", options.cull)
                                        : "--recording requires --cull frustum, occlusion or depth");
  }
  if (!culls) return {};
  const auto how = console::open_options(options.reading);
  if (!how) return tl::unexpected(how.error());
  const auto folder = suites::find_recording(options.recording, options.data);
  if (!folder) return tl::unexpected(folder.error());
  const auto recording = datasets::open_recording(*folder, *how);
  if (!recording) return tl::unexpected(recording.error());
  if (recording->ground_truth.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{} has no ground truth", options.recording),
                "culling requires the camera poses of the ground truth");
  }
  auto views = run::recorded_views(*recording, {options.depth_range_m[0], options.depth_range_m[1],
                                                culling_of(options.cull), options.cull_every});
  if (!views) return tl::unexpected(views.error());
  if (views->T_truth_camera.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no frame has ground truth", options.recording),
                "culling requires the camera poses of the ground truth");
  }
  request.views = std::move(*views);
  return {};
}

/// The parser takes "nan" for a number within any range.
Result<void> check_numbers(const MeshVerbOptions& options) {
  const auto refuse = [](const char* option) {
    return fail(ErrorCode::usage, fmt::format("{} requires finite numbers", option));
  };
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(options.thresholds_m, is_finite)) return refuse("--thresholds");
  if (!std::ranges::all_of(options.depth_range_m, is_finite)) return refuse("--depth-range");
  if (!is_finite(options.scale.value_or(1))) return refuse("--scale");
  if (!is_finite(options.colored_max_m.value_or(1))) return refuse("--colored-max");
  if (options.colored_max_m && options.colored.empty())
    return fail(ErrorCode::usage, "--colored-max requires --colored FILE.ply");
  if (!is_finite(options.icp_kept.value_or(1))) return refuse("--icp-kept");
  if (!is_finite(options.least_observed)) return refuse("--min-observed");
  if (options.depth_range_m[0] < options.depth_range_m[1]) return {};
  return fail(ErrorCode::usage, fmt::format("--depth-range {} {}: the nearest depth comes first",
                                            options.depth_range_m[0], options.depth_range_m[1]));
}

}  // namespace

Result<mesh_error::MeshRequest> request_of(const MeshVerbOptions& options) {
  mesh_error::MeshRequest request;
  if (auto sound = check_numbers(options); !sound) return tl::unexpected(sound.error());
  const auto sampling = sampling_of(options);
  if (!sampling) return tl::unexpected(sampling.error());
  request.errors = {*sampling, *sampling, options.thresholds_m};
  std::ranges::sort(request.errors.thresholds_m);
  request.any_size = options.scale.has_value();
  request.least_observed = options.least_observed;
  request.vertex_errors = !options.colored.empty();
  for (const auto& set : {set_alignment(options, request), set_views(options, request)}) {
    if (!set) return tl::unexpected(set.error());
  }
  return request;
}

}  // namespace fusebench::cli::evaluation
