// The record of one run: what was asked, what came out, and what made it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/options.hpp"
#include "core/estimator/filter/sensor_constants.hpp"
#include "datasets/calibration/camera_model.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "eval/metrics/intensity_readings.hpp"
#include "eval/metrics/loop_error/loop_metrics.hpp"
#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "eval/metrics/nees_metrics.hpp"
#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/residual_metrics.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"
#include "eval/metrics/trajectory_error/fitted_offset.hpp"
#include "eval/metrics/trajectory_error/silent_failures.hpp"
#include "eval/record/duration_histogram.hpp"

namespace fusebench::record {

inline constexpr int kRecordSchema = 1;
/// A larger file is no record.
inline constexpr std::uintmax_t kMostRecordBytes = std::uintmax_t{1} << 28;

/// The word for a ground truth that `fusebench smooth` made from the recording itself.
inline constexpr std::string_view kPseudoTruthWord = "pseudo ground truth";
/// In the place of such words where a record cannot be read.
inline constexpr std::string_view kUnknownWord = "unknown";

enum class RunStatus {
  failed,  ///< ended by an error
  lost,    ///< too many lost frames in a row
  ok,
};
[[nodiscard]] std::string_view to_string(RunStatus status);
[[nodiscard]] std::optional<RunStatus> parse_run_status(std::string_view text);
/// Which poses of a run its metrics are of.
enum class PoseKind {
  online,  ///< as each was known when its frame came
  final,   ///< as all were known at the end
};
[[nodiscard]] std::string_view to_string(PoseKind poses);
[[nodiscard]] std::optional<PoseKind> parse_pose_kind(std::string_view text);
/// The status as people see it: "ok (12 undetected)" where so many of the poses that were claimed are wrong.
[[nodiscard]] std::string status_text(RunStatus status, std::optional<std::size_t> silent);

/// A metric's result, or why there is none.
template <class T>
struct Outcome {
  std::optional<T> value;
  std::string reason = "not computed";
  std::string hint = {};  ///< what to do then; records do not hold it

  [[nodiscard]] static Outcome from(Result<T> result) {
    if (result) return {std::move(*result), {}};
    return {std::nullopt, result.error().message, result.error().hint};
  }
};

struct RecordedOption {
  std::string key;
  config::OptionValue value;
  std::string origin;
};

/// A program from outside, as it was called.
struct RecordedProgram {
  std::string definition;  ///< the text of its file
  std::string version;     ///< what it says of itself; empty if it cannot be asked
  int seed = 1;
};

/// The camera that images and depth were read with, whoever gave it.
struct RecordedCamera {
  calibration::CalibratedCamera color;          ///< before undistortion; with the timing of depth as well
  std::optional<double> depth_units_per_metre;  ///< none where depth is stored in metres
};

struct RecordedRecording {
  std::string name;
  std::string format;
  std::string data = "recorded";  ///< or "simulated": with its truth and its IMU made by a simulator
  std::size_t frames = 0;         ///< that the run was asked to process
  std::size_t first_frame = 0;
  double duration_s = 0;  ///< first to last of these frames
  std::string fingerprint;
  std::string imu = "none";  ///< that the run used: "none", "recorded", "synthetic IMU"
  std::string imu_note;
  /// What trajectories are compared with: "none", "given", kPseudoTruthWord; empty in a record that is older.
  std::string truth = "none";
  std::vector<std::string> notes;  ///< what was done to the data on reading, then "warning: ..." lines
  std::optional<RecordedCamera> camera = {};  ///< none in a record that is older
  bool prepared = false;  ///< constants of its sensors were measured first: camera and notes say which
  std::optional<std::int64_t> start_ns = {};  ///< stamp of the first of these frames; none in an older record
  /// Frames of the whole recording if the run processed a part of it; 0 if it processed all, or of an older
  /// record.
  std::size_t whole_frames = 0;
};

/// In the order of kStateParts.
using RecordedNees = std::array<Outcome<metrics::NeesResult>, metrics::kStateParts.size()>;

/// The model against the true scene, under three alignments.
struct RecordedMesh {
  mesh_error::MeshSampling reconstruction_sampling;
  mesh_error::MeshSampling truth_sampling;
  std::size_t reconstruction_samples = 0;
  std::size_t truth_samples = 0;
  std::size_t truth_observed = 0;  ///< those of them that completeness is of
  std::size_t views = 0;           ///< true poses that observe
  double min_depth_m = 0;          ///< in which they do
  double max_depth_m = 0;
  mesh_error::MeshErrorResult poses;                     ///< by all poses of the trajectory: the main result
  mesh_error::MeshErrorResult first_camera;              ///< by the true pose of the first camera
  std::optional<mesh_error::MeshErrorResult> positions;  ///< by ATE's alignment, which sees positions only
  /// Distance of each vertex to the true surface, aligned by all poses: in mesh.ply, not in the record.
  std::vector<double> vertex_errors_m;
};

/// The intensity error of the poses alone (pose_intensity.hpp), over the frames of which this run has poses.
struct RecordedPoseIntensity {
  double aie_grey = 0;
  double rms_grey = 0;
  std::size_t frames = 0;
  std::size_t pixels = 0;
  bool visibility_by_truth = false;
};

/// Poses that were claimed and are wrong.
struct RecordedSilentFailures {
  trajectory_error::SilentFailures failures;
  std::optional<std::size_t> first_frame;  ///< the first one's, counted from the run's first frame
};

struct RecordedMetrics {
  Outcome<trajectory_error::AteResult> ate;
  Outcome<trajectory_error::FittedOffset> ate_fitted;  ///< with a fitted offset of the reference's body
  Outcome<trajectory_error::RpeResult> rpe_frame;      ///< over one frame
  Outcome<trajectory_error::RpeResult> rpe_second;     ///< over one second
  Outcome<metrics::IntensityResult> aie;
  Outcome<metrics::IntensityReadings> intensity_readings;  ///< by other definitions
  Outcome<RecordedMesh> mesh;
  RecordedNees nees;
  Outcome<metrics::ResidualSummary> residuals;
  Outcome<RecordedSilentFailures> silent;
  Outcome<RecordedPoseIntensity> pose_intensity;
  Outcome<reference_clock::ReferenceClock> reference_clock;

  /// Number of undetected failures, where there is truth to tell them by.
  [[nodiscard]] std::optional<std::size_t> silent_frames() const {
    return silent.value ? std::optional(silent.value->failures.silent) : std::nullopt;
  }
};

struct RecordedFrames {
  std::size_t total = 0;            ///< that the run was asked to process
  std::size_t tracked = 0;          ///< including the first
  std::size_t lost = 0;             ///< processed and lost
  std::size_t other_segments = 0;   ///< tracked apart from the map; what is left of the total was not reached
  std::size_t segments = 0;         ///< stretches that were tracked apart from the map
  std::size_t segments_joined = 0;  ///< of them, those that were joined to it
};

/// "12 frames in 2 segments apart from the map, 1 joined"; empty without segments.
[[nodiscard]] std::string segments_text(const RecordedFrames& frames);

/// Tracked frames / requested frames; 0 of a run that did not begin.
[[nodiscard]] double coverage_share(const RecordedFrames& frames);

struct RecordedModel {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t blocks = 0;
};

/// A file of a run as it was written, beside its record.
struct RecordedFile {
  std::string name;  ///< relative to the run's folder, with "/"
  std::uint64_t bytes = 0;
  std::string xxh3;  ///< Fingerprint::add_file() of it

  friend bool operator==(const RecordedFile&, const RecordedFile&) = default;
};

/// Never the same twice.
struct RecordedTiming {
  double wall_s = 0;
  double cpu_s = 0;
  std::uint64_t peak_rss_bytes = 0;
  double fps = 0;                                         ///< processed frames / wall_s
  std::vector<std::pair<std::string, double>> stages_ms;  ///< mean over frames
  /// stage_histograms() of a profiled run; empty of others.
  std::vector<std::pair<std::string, DurationHistogram>> histograms = {};
  std::vector<RecordedFile> files = {};  ///< those that hold times, as frames.csv does
};

struct RecordedProvenance {
  std::string version;
  std::string git;
  std::string compiler;
  std::string flags;
  std::string estimator;  ///< BuildInfo::estimator; empty in older records
  std::string cpu;
  int threads = 0;
  std::string host;
};

/// Starts as a failed run; becomes good.
struct RunRecord {
  int schema = kRecordSchema;
  RunStatus status = RunStatus::failed;
  std::string reason = "not run";  ///< empty if ok
  std::string run_id;  ///< run_identity(): all that the results depend on; empty if that was never known
  int repetition = 1;  ///< of the same run, for its time
  int replicate =
      0;  ///< above 0: from an initial pose with noise (system.replicate_noise), to see what chance does
  RecordedRecording recording;
  std::string variant;
  std::optional<RecordedProgram> program;  ///< that ran in place of a variant
  PoseKind poses = PoseKind::online;
  std::vector<RecordedOption> config;  ///< every option, in declaration order; of a program the evaluation's
  std::string config_hash;             ///< of the configuration; the identity of a program
  RecordedMetrics metrics;
  /// Of the poses as the system revised them at the end, which the model is fused at; nothing if it did not.
  std::optional<RecordedMetrics> final_metrics;
  /// Of a system that looks for loops, where there is truth.
  std::optional<Outcome<loop_error::LoopError>> loops;
  RecordedFrames frames;
  RecordedModel model;
  std::vector<filter::SensorConstant> sensors;  ///< after the last tracked frame; those that were estimated
  std::vector<RecordedFile> files;  ///< by name, without those that hold times; empty in older records
  RecordedTiming timing;
  RecordedProvenance provenance;
};

/// A record of a number that is NaN or infinite becomes that of a failed run without metrics, whose reason
/// has the number's place ("metrics.ate.stats.rmse = nan"): JSON has no such numbers, and nobody could
/// compare them.
void fail_if_not_finite(RunRecord& record);

/// JSON with two blanks of indentation. Everything outside `timing` and `provenance` depends on the inputs
/// alone. Statistics are SI; numbers that do not exist are null, with a reason beside them.
[[nodiscard]] std::string to_json(const RunRecord& record);

/// What is wrong with a text that the parser took for no JSON at a byte, which it counts from 1: "not JSON at
/// byte 4097 (zeros after a power cut?)".
[[nodiscard]] std::string no_json(std::string_view text, std::size_t byte);

/// Errors, with the name (a file, for messages) and what is missing or wrong: data_corrupt; configuration if
/// it has the schema of another version of this program.
[[nodiscard]] Result<RunRecord> parse_record(std::string_view json, const std::string& name);

/// Errors: data_missing, and those of parse_record.
[[nodiscard]] Result<RunRecord> read_record(const std::filesystem::path& file);

}  // namespace fusebench::record
