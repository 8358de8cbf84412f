#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/mesh_file.hpp"
#include "core/mesh/ply_file.hpp"
#include "datasets/open_recording.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/mesh_error/error_colors.hpp"
#include "eval/mesh_error/mesh_evaluation.hpp"
#include "eval/mesh_error/transform_file.hpp"
#include "eval/metric_reports/mesh_report.hpp"
#include "eval/run/recording_views.hpp"
#include "eval/suites/experiment.hpp"
#include "eval/trajectory_error/pose_alignment.hpp"
#include "eval/trajectory_files/trajectory_formats.hpp"
#include "eval/trajectory_files/trajectory_pair.hpp"

namespace fusebench::cli::evaluation {

namespace {

struct MeshVerbOptions {
  std::filesystem::path reconstruction;
  std::filesystem::path truth;
  std::string align = "none";
  std::filesystem::path transform;
  std::vector<std::filesystem::path> trajectories;  ///< reference and estimate
  std::optional<double> icp_kept;
  std::optional<double> scale;
  std::vector<double> thresholds_m = mesh_error::MeshErrorOptions{}.thresholds_m;
  std::string samples = "200000";
  std::uint64_t seed = 1;
  std::string cull = "none";
  std::string recording;
  std::filesystem::path data;
  console::ReadingOptions reading;
  std::size_t cull_every = run::RecordedViewOptions{}.every_frames;
  std::vector<double> depth_range_m = {0.1, 10};
  double least_observed = mesh_error::MeshRequest{}.least_observed;
  std::filesystem::path colored;
  std::optional<double> colored_max_m;
  int threads = 1;
  bool json = false;
};

Result<mesh_error::MeshSampling> sampling_of(const MeshVerbOptions& options) {
  if (options.samples == "vertices") return mesh_error::MeshSampling{mesh_error::MeshSamples::vertices, 0, 0};
  mesh_error::MeshSampling sampling{mesh_error::MeshSamples::area, 0, options.seed};
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
  std::vector<std::string> warnings;
  const auto reference =
      trajectory_files::load_trajectory(files[0], std::nullopt, trajectory::Duplicates::rare_last, warnings);
  if (!reference) return tl::unexpected(reference.error());
  const auto estimate =
      trajectory_files::load_trajectory(files[1], std::nullopt, trajectory::Duplicates::rare_last, warnings);
  if (!estimate) return tl::unexpected(estimate.error());
  for (const std::string& warning : warnings) console::print_progress("warning: " + warning);
  const bool stamps = reference->has_stamps() && estimate->has_stamps();
  constexpr double kMaxGap_s = 0.1;
  const auto pair = trajectory_files::pair_up(
      reference->poses, estimate->poses,
      {stamps ? trajectory_files::AssociationRule::interpolated : trajectory_files::AssociationRule::index,
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
    return fail(ErrorCode::usage, "--transform and --trajectories both say where the reconstruction is");
  if (options.align == "none" && (file || trajectories)) {
    return fail(
        ErrorCode::usage,
        fmt::format("--align none does not use {}", file ? "--transform" : "--trajectories"),
        fmt::format("--align {} does, and --align icp starts from there", file ? "file" : "trajectory"));
  }
  if (options.align == "file" && !file) return fail(ErrorCode::usage, "--align file needs --transform FILE");
  if (options.align == "trajectory" && !trajectories)
    return fail(ErrorCode::usage, "--align trajectory needs --trajectories TRUTH ESTIMATE");
  if (file || trajectories) {
    const auto start = file ? mesh_error::read_transform(options.transform)
                            : alignment_of_trajectories(options.trajectories);
    if (!start) return tl::unexpected(start.error());
    request.start = {file ? "file" : "trajectory", *start};
  }
  if (options.align == "icp")
    request.icp = mesh_error::RegistrationOptions{
        .kept = options.icp_kept.value_or(mesh_error::RegistrationOptions{}.kept)};
  if (options.icp_kept && !request.icp) return fail(ErrorCode::usage, "--icp-kept is for --align icp");
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
    return fail(ErrorCode::usage, culls ? fmt::format("--cull {} needs --recording REC", options.cull)
                                        : "--recording is for --cull frustum, occlusion or depth");
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
                "only true poses tell what of the true surface was seen");
  }
  auto views = run::recorded_views(*recording, {options.depth_range_m[0], options.depth_range_m[1],
                                                culling_of(options.cull), options.cull_every});
  if (!views) return tl::unexpected(views.error());
  if (views->T_truth_camera.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no frame has ground truth", options.recording),
                "only true poses tell what of the true surface was seen");
  }
  request.views = std::move(*views);
  return {};
}

/// The parser takes "nan" for a number within any range.
Result<void> check_numbers(const MeshVerbOptions& options) {
  const auto refuse = [](const char* option) {
    return fail(ErrorCode::usage, fmt::format("{} needs numbers that are finite", option));
  };
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(options.thresholds_m, is_finite)) return refuse("--thresholds");
  if (!std::ranges::all_of(options.depth_range_m, is_finite)) return refuse("--depth-range");
  if (!is_finite(options.scale.value_or(1))) return refuse("--scale");
  if (!is_finite(options.colored_max_m.value_or(1))) return refuse("--colored-max");
  if (options.colored_max_m && options.colored.empty())
    return fail(ErrorCode::usage, "--colored-max is for --colored FILE.ply");
  if (!is_finite(options.icp_kept.value_or(1))) return refuse("--icp-kept");
  if (!is_finite(options.least_observed)) return refuse("--min-observed");
  if (options.depth_range_m[0] < options.depth_range_m[1]) return {};
  return fail(ErrorCode::usage, fmt::format("--depth-range {} {}: the nearest depth comes first",
                                            options.depth_range_m[0], options.depth_range_m[1]));
}

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

Result<void> write_colored(const MeshVerbOptions& options, PreciseMesh mesh,
                           const mesh_error::MeshEvaluation& evaluation) {
  const double largest_m = options.colored_max_m.value_or(evaluation.errors.thresholds.back().tau_m);
  const SE3& T_truth_reconstruction = evaluation.errors.alignment.T_reference_estimate;
  for (Vector3d& vertex : mesh.vertices) vertex = T_truth_reconstruction * vertex;
  mesh.normals.clear();
  mesh.colors = mesh_error::error_colors(evaluation.vertex_errors_m, largest_m);
  mesh.quality.assign(evaluation.vertex_errors_m.begin(), evaluation.vertex_errors_m.end());
  const std::filesystem::path unfinished = options.colored.string() + ".part";
  if (auto written = mesh::write_ply(mesh.cast<float>(), unfinished); !written) return written;
  std::error_code error;
  std::filesystem::rename(unfinished, options.colored, error);
  if (error)
    return fail(ErrorCode::io,
                fmt::format("{}: cannot be written: {}", options.colored.string(), error.message()));
  console::print_progress(
      fmt::format("{}: the reconstruction in the truth's world, dark blue on the true surface to yellow at "
                  "{:g} m from it and beyond",
                  options.colored.string(), largest_m));
  return {};
}

void warn(const mesh_error::MeshEvaluation& evaluation) {
  constexpr double kRoom_m = 1000;
  if (evaluation.truth.extent_m.norm() > kRoom_m) {
    console::print_progress(fmt::format("warning: the truth measures {:.4g} m: are both meshes in metres?",
                                        evaluation.truth.extent_m.norm()));
  }
  const mesh_error::MeshThreshold& widest = evaluation.errors.thresholds.back();
  if (widest.precision == 0) {
    console::print_progress(
        fmt::format("warning: no part of the reconstruction is within {:g} m of the truth: is it in the "
                    "truth's world? --align moves it there",
                    widest.tau_m));
  }
}

Result<int> run(const MeshVerbOptions& options) {
  const auto request = request_of(options);
  if (!request) return tl::unexpected(request.error());
  auto reconstruction = mesh::read_mesh(options.reconstruction);
  if (!reconstruction) return tl::unexpected(reconstruction.error());
  const auto truth = mesh::read_mesh(options.truth);
  if (!truth) return tl::unexpected(truth.error());
  const double scale = options.scale.value_or(1.0);
  if (scale != 1) {
    for (Vector3d& vertex : reconstruction->vertices) vertex *= scale;
  }
  const Workers workers(options.threads);
  const auto evaluation = mesh_error::evaluate_mesh(*reconstruction, *truth, *request, workers);
  if (!evaluation) return tl::unexpected(evaluation.error());
  warn(*evaluation);
  if (!options.colored.empty()) {
    if (auto written = write_colored(options, std::move(*reconstruction), *evaluation); !written)
      return tl::unexpected(written.error());
  }
  const metric_reports::ComparedMeshes files = {options.reconstruction.string(), options.truth.string(),
                                                scale, options.recording};
  console::print_output(options.json ? metric_reports::to_json(*evaluation, *request, files)
                                     : metric_reports::to_text(*evaluation, *request, files));
  return 0;
}

void add_alignment_options(CLI::App& verb, MeshVerbOptions& options) {
  verb.add_option(
          "--align", options.align,
          "What moves the reconstruction: none, file (--transform), trajectory (--trajectories), or icp "
          "(onto the true surface, rigidly; from there if one of these is given)")
      ->check(CLI::IsMember({"none", "file", "trajectory", "icp"}))
      ->type_name("MODE")
      ->capture_default_str();
  verb.add_option("--transform", options.transform,
                  "Rigid 4x4 that takes the reconstruction to the truth, row by row")
      ->type_name("FILE");
  verb.add_option("--trajectories", options.trajectories,
                  "True and estimated trajectory (TUM, KITTI or EuRoC) in the worlds of the meshes")
      ->expected(2)
      ->type_name("TRUTH ESTIMATE");
  verb.add_option("--icp-kept", options.icp_kept,
                  fmt::format("Of the points, those nearest to the truth that icp counts [{}]",
                              mesh_error::RegistrationOptions{}.kept))
      ->check(CLI::Range(0.01, 1.0))
      ->type_name("SHARE");
  verb.add_option("--scale", options.scale,
                  "Metres of a unit of the reconstruction (0.001: millimetres); given, no size is refused")
      ->check(CLI::Range(1e-9, 1e9))
      ->type_name("S");
}

void add_culling_options(CLI::App& verb, MeshVerbOptions& options) {
  verb.add_option(
          "--cull", options.cull,
          "Truth that counts: none (all of it), or what true poses of a recording have in their frustum, "
          "see without occlusion by the truth, or have measured in their depth images")
      ->check(CLI::IsMember({"none", "frustum", "occlusion", "depth"}))
      ->type_name("MODE")
      ->capture_default_str();
  verb.add_option("--recording", options.recording,
                  "Folder of the recording that --cull looks from, or the name of one under --data")
      ->type_name("REC");
  verb.add_option("--cull-every", options.cull_every, "Looks from every N-th frame")
      ->check(CLI::PositiveNumber)
      ->type_name("N")
      ->capture_default_str();
  verb.add_option("--depth-range", options.depth_range_m,
                  "Nearest and farthest depth that counts as seen, metres")
      ->expected(2)
      ->check(CLI::NonNegativeNumber)
      ->type_name("MIN MAX")
      ->capture_default_str();
  verb.add_option("--min-observed", options.least_observed,
                  "Share of the truth that must be observed for its completeness to mean something")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE")
      ->capture_default_str();
  console::add_reading_options(verb, options.reading);
  console::add_data_option(verb, options.data);
}

}  // namespace

console::Verb add_eval_mesh_verb(CLI::App& eval) {
  auto options = std::make_shared<MeshVerbOptions>();
  CLI::App* verb = eval.add_subcommand(
      "mesh", "Accuracy and completeness of a mesh by exact distances (CloudCompare C2M, SurfReg, F scores)");
  verb->add_option("RECONSTRUCTION", options->reconstruction, "Mesh to judge, .ply or .obj")->required();
  verb->add_option("GROUNDTRUTH", options->truth, "True mesh, .ply or .obj")->required();
  add_alignment_options(*verb, *options);
  verb->add_option("--thresholds", options->thresholds_m,
                   "Distances (metres) below which points count for precision, recall and F")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber)
      ->type_name("M,M,...")
      ->capture_default_str();
  verb->add_option("--samples", options->samples,
                   "Points of either mesh: a number, even over its area, or vertices")
      ->type_name("N|vertices")
      ->capture_default_str();
  verb->add_option("--seed", options->seed, "Of the points over the area")
      ->type_name("N")
      ->capture_default_str();
  add_culling_options(*verb, *options);
  verb->add_option("--colored", options->colored,
                   "Writes the reconstruction coloured by its distance to the truth")
      ->type_name("FILE.ply");
  verb->add_option("--colored-max", options->colored_max_m,
                   "Distance of the last colour; default: the largest threshold")
      ->check(CLI::PositiveNumber)
      ->type_name("M");
  console::add_threads_option(*verb, options->threads);
  console::add_json_flag(*verb, options->json);
  verb->footer("docs/metrics.md defines the numbers. Exit code 3 for meshes that cannot be compared.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::evaluation
