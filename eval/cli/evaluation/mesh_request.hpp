// The request of `fusebench eval mesh` from its options.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/metrics/mesh_error/mesh_evaluation.hpp"
#include "eval/run/recording_views.hpp"

namespace fusebench::cli::evaluation {

/// The options as given.
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
  std::optional<std::uint64_t> seed;  ///< 1 if not given
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

/// The request, with the requested alignment and views of a recording. Errors: usage
/// for options that do not go together; those of the files that are read; data_missing for a recording
/// without ground truth.
[[nodiscard]] Result<mesh_error::MeshRequest> request_of(const MeshVerbOptions& options);

}  // namespace fusebench::cli::evaluation
