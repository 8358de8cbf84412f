#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/staged_file.hpp"
#include "core/base/mesh/mesh_file.hpp"
#include "core/base/mesh/ply_file.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/cli/evaluation/mesh_request.hpp"
#include "eval/metrics/mesh_error/error_colors.hpp"
#include "eval/metrics/mesh_error/mesh_evaluation.hpp"
#include "eval/report/metric_reports/mesh_report.hpp"

namespace fusebench::cli::evaluation {

namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& file, const std::error_code& error) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", file.string(), error.message()),
              "choose a file in a folder that can be written");
}

Result<void> write_colored(const MeshVerbOptions& options, PreciseMesh mesh,
                           const mesh_error::MeshEvaluation& evaluation) {
  const double largest_m = options.colored_max_m.value_or(evaluation.errors.thresholds.back().tau_m);
  const SE3& T_truth_reconstruction = evaluation.errors.alignment.T_reference_estimate;
  for (Vector3d& vertex : mesh.vertices) vertex = T_truth_reconstruction * vertex;
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = (T_truth_reconstruction.rotation * normal.cast<double>()).cast<float>();
  mesh.colors = mesh_error::error_colors(evaluation.vertex_errors_m, largest_m);
  mesh.quality.assign(evaluation.vertex_errors_m.begin(), evaluation.vertex_errors_m.end());
  std::error_code ignored;
  // Writing reports an error if the folder does not exist afterwards.
  if (options.colored.has_parent_path())
    std::filesystem::create_directories(options.colored.parent_path(), ignored);
  auto file = io::StagedFile::create(options.colored);
  if (!file) return cannot_write(options.colored, file.error());
  if (auto written = mesh::write_ply(mesh.cast<float>(), *file); !written) return written;
  if (const std::error_code error = file->commit()) return cannot_write(options.colored, error);
  console::print_progress(
      fmt::format("{}: the reconstruction in the frame of the ground truth, dark blue on its surface to "
                  "yellow at {:g} m and more",
                  options.colored.string(), largest_m));
  return {};
}

void warn(const mesh_error::MeshEvaluation& evaluation) {
  constexpr double kRoom_m = 1000;
  if (evaluation.truth.extent_m.norm() > kRoom_m) {
    console::print_progress(
        fmt::format("warning: the ground truth measures {:.4g} m: are both meshes in metres?",
                    evaluation.truth.extent_m.norm()));
  }
  for (const auto& [shape, what] : {std::pair(&evaluation.reconstruction, "the reconstruction"),
                                    std::pair(&evaluation.truth, "the ground truth")}) {
    if (shape->unused_vertices == 0) continue;
    console::print_progress(
        fmt::format("warning: {} of {} vertices of {} belong to no triangle: its size does not include them; "
                    "SurfReg's score and --samples vertices do",
                    shape->unused_vertices, shape->vertices + shape->unused_vertices, what));
  }
  if (evaluation.icp && !evaluation.icp->converged) {
    console::print_progress(
        fmt::format("warning: icp has not converged after {} steps: the result may depend on its start",
                    evaluation.icp->steps));
  }
  if (!evaluation.icp_doubt.empty()) console::print_progress("warning: " + evaluation.icp_doubt);
  const mesh_error::MeshThreshold& widest = evaluation.errors.thresholds.back();
  if (widest.precision == 0) {
    console::print_progress(
        fmt::format("warning: no part of the reconstruction is within {:g} m of the ground truth: are both "
                    "in one frame? --align moves the reconstruction",
                    widest.tau_m));
  }
}

Result<int> run(const MeshVerbOptions& options) {
  const auto request = request_of(options);
  if (!request) return tl::unexpected(request.error());
  console::Progress progress("reading the meshes");
  auto reconstruction = mesh::read_mesh(options.reconstruction);
  if (!reconstruction) return tl::unexpected(reconstruction.error());
  auto truth = mesh::read_mesh(options.truth);
  if (!truth) return tl::unexpected(truth.error());
  const double scale = options.scale.value_or(1.0);
  reconstruction = mesh::scaled(*std::move(reconstruction), scale);
  progress.say("measuring distances between the meshes");
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
          "Alignment of the reconstruction: none, file (--transform), trajectory (--trajectories), or icp "
          "(rigid, onto the ground-truth surface; starts at --transform or --trajectories if given)")
      ->check(CLI::IsMember({"none", "file", "trajectory", "icp"}))
      ->type_name("MODE")
      ->capture_default_str();
  verb.add_option("--transform", options.transform,
                  "Rigid 4x4 transform from the reconstruction to the ground truth, row by row")
      ->type_name("FILE");
  verb.add_option("--trajectories", options.trajectories,
                  "Ground-truth and estimated trajectory (TUM, KITTI or EuRoC) in the frames of the meshes")
      ->expected(2)
      ->type_name("TRUTH ESTIMATE");
  verb.add_option("--icp-kept", options.icp_kept,
                  fmt::format("Share of the points that icp uses, nearest to the ground truth first [{}]",
                              mesh_error::RegistrationOptions{}.kept))
      ->check(console::number_range(0.01, 1.0))
      ->type_name("SHARE");
  verb.add_option("--scale", options.scale,
                  "Metres per unit of the reconstruction (0.001: millimetres); disables the check of sizes")
      ->check(console::number_range(1e-9, 1e9))
      ->type_name("S");
}

void add_culling_options(CLI::App& verb, MeshVerbOptions& options) {
  auto* cull =
      verb.add_option("--cull", options.cull,
                      "Culling of the ground-truth surface by the ground-truth poses of a recording: none, "
                      "frustum, occlusion (visible in the mesh), or depth (measured in the depth images)")
          ->check(CLI::IsMember({"none", "frustum", "occlusion", "depth"}))
          ->type_name("MODE")
          ->capture_default_str();
  verb.add_option("--recording", options.recording,
                  "Folder of the recording of --cull, or the name of one under --data")
      ->type_name("REC");
  verb.add_option("--cull-every", options.cull_every, "Uses every N-th frame for --cull")
      ->check(console::positive())
      ->type_name("N")
      ->capture_default_str();
  verb.add_option("--depth-range", options.depth_range_m, "Range of depth that counts as observed, metres")
      ->expected(2)
      ->check(console::not_negative())
      ->type_name("MIN MAX")
      ->capture_default_str();
  verb.add_option("--min-observed", options.least_observed,
                  "Least share of the ground truth that must be observed")
      ->check(console::number_range(0.0, 1.0))
      ->type_name("SHARE")
      ->capture_default_str();
  const std::size_t count = verb.get_options().size();
  console::add_reading_options(verb, options.reading);
  for (const char* option : {"--cull-every", "--depth-range", "--min-observed"})
    verb.get_option(option)->needs(cull);
  for (std::size_t k = count; k < verb.get_options().size(); ++k) verb.get_options()[k]->needs(cull);
  console::add_data_option(verb, options.data);
}

}  // namespace

console::Verb add_eval_mesh_verb(CLI::App& eval) {
  auto options = std::make_shared<MeshVerbOptions>();
  CLI::App* verb = eval.add_subcommand("mesh",
                                       "Evaluates accuracy and completeness of a mesh by exact distances "
                                       "(CloudCompare C2M, SurfReg, F scores)");
  verb->add_option("RECONSTRUCTION", options->reconstruction, "Mesh to evaluate, .ply or .obj")->required();
  verb->add_option("GROUNDTRUTH", options->truth, "Ground-truth mesh, .ply or .obj")->required();
  add_alignment_options(*verb, *options);
  verb->add_option("--thresholds", options->thresholds_m,
                   "Distances (metres) below which points count for precision, recall and F")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(console::positive())
      ->type_name("M,M,...")
      ->capture_default_str();
  verb->add_option("--samples", options->samples,
                   "Points of each mesh: a number, spread evenly over its area, or vertices")
      ->type_name("N|vertices")
      ->capture_default_str();
  verb->add_option("--seed", options->seed, "Seed of the points over the area [1]")->type_name("N");
  add_culling_options(*verb, *options);
  verb->add_option("--colored", options->colored,
                   "Writes the reconstruction coloured by its distance to the ground truth")
      ->type_name("FILE.ply");
  verb->add_option("--colored-max", options->colored_max_m,
                   "Distance of the last colour; default: the largest threshold")
      ->check(console::positive())
      ->type_name("M");
  console::add_threads_option(*verb, options->threads);
  console::add_json_flag(*verb, options->json);
  verb->footer("docs/metrics.md defines the numbers. Exit code 3 for meshes that cannot be compared.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::evaluation
