#include "datasets/simulator/motion/motion_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/io/input_file.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "datasets/recording/formats/icl/icl_conventions.hpp"

namespace fusebench::simulator::motion {

namespace {

constexpr double kIclRate_hz = 30;
// ICL-NUIM's paths are estimates of a hand-held camera with jumps of millimetres between frames. Hand motion
// ends at about 3 Hz; higher frequencies would give accelerations of several g.
constexpr double kIclCutoff_hz = 3;
constexpr double kMost_m = 1e7;       // limit of recordings: squares of larger distances overflow
constexpr double kFitMargin_s = 0.5;  // extra length, since a fit is less accurate at its ends

constexpr std::string_view kMatrixColumns = "index r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz";

/// Converts a pose of ICL-NUIM to a camera of this project in a world with z up.
SE3 from_icl(const SE3& T_icl) {
  static const Quaterniond kUpright((Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished());  // y down to z up
  return SE3{kUpright, Vector3d::Zero()} * formats::icl::icl_reflect(T_icl);
}

Result<std::size_t> count_columns(const std::filesystem::path& file) {
  std::ifstream stream = io::input_file(file);
  if (!stream) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()),
                "give a trajectory file: TUM columns, or one of ICL-NUIM's");
  }
  std::string buffer(io::TextTable::kMaxLineLength + 1, '\0');
  std::vector<std::string_view> fields;
  int line = 1;
  for (; stream.getline(buffer.data(), static_cast<std::streamsize>(buffer.size())); ++line) {
    io::split_fields(buffer.c_str(), fields);
    if (!fields.empty() && !fields.front().empty() && fields.front().front() != '#') return fields.size();
  }
  if (!stream.eof() && !stream.bad()) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: line is longer than {} characters",
                                                     file.string(), line, io::TextTable::kMaxLineLength));
  }
  return fail(ErrorCode::data_corrupt, fmt::format("{}: holds no pose", file.string()));
}

Result<Trajectory> read_matrices(const std::filesystem::path& file) {
  Trajectory poses;
  const auto row = [&](const io::TextTable& table, std::int64_t index_ns) -> Result<void> {
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix;
    if (auto read = table.numbers(1, {matrix.data(), 12}); !read) return read;
    const Matrix3d rotation = matrix.leftCols<3>();
    const double error = (rotation * rotation.transpose() - Matrix3d::Identity()).norm();
    if (!(error < 1e-3) || rotation.determinant() < 0) {
      return table.fail_here("the matrix is no rotation (orthonormal within 1e-3, determinant 1)");
    }
    poses.push_back({index_ns, {Quaterniond(rotation).normalized(), matrix.col(3)}});
    return {};
  };
  const Result<void> done = io::for_each_stamped_row(file, kMatrixColumns, io::TimeOrder::increasing, row);
  if (!done) return tl::unexpected(done.error());
  return poses;
}

void start_at_zero(Trajectory& poses) {
  const std::int64_t first_ns = poses.front().timestamp_ns;
  for (StampedPose& pose : poses) pose.timestamp_ns -= first_ns;
}

/// Converts indices, read as seconds, to frame times.
void take_indices_as_frames(Trajectory& poses) {
  for (StampedPose& pose : poses) {
    pose.timestamp_ns = std::llround(static_cast<double>(pose.timestamp_ns) / kIclRate_hz);
    pose.T_world_camera = from_icl(pose.T_world_camera);
  }
}

PathClock clock_for(const FileMotionOptions& options, double lead_s) {
  PathClock clock;
  clock.rate = options.speed;
  clock.offset_s = options.skip_s;
  if (options.from_rest) {
    clock.still_until_s = lead_s + options.rest_s;
    clock.start_s = options.start_s;
  }
  return clock;
}

/// The part of the path that a span requires, as a spline by path time.
Result<synthetic_imu::PoseSpline> smooth_path(const FilePath& path, double needed_s) {
  Trajectory part;
  for (const StampedPose& pose : path.poses) {
    if (seconds_between(0, pose.timestamp_ns) <= needed_s + kFitMargin_s) part.push_back(pose);
  }
  synthetic_imu::SplineFitOptions fit;
  fit.cutoff_hz = path.cutoff_hz;
  // The jitter of a path is not treated as outliers.
  fit.outlier_position_m = 0.1;
  fit.outlier_rotation_rad = 0.1;
  auto fitted = synthetic_imu::fit_pose_spline(part, fit);
  if (!fitted) return tl::unexpected(fitted.error());
  return std::move(fitted->spline);
}

Eigen::AlignedBox3d extent_of(const synthetic_imu::PoseSpline& spline, double heading_rad) {
  const Eigen::AngleAxisd turn(heading_rad, Vector3d::UnitZ());
  Eigen::AlignedBox3d extent;
  for (const Vector3d& point : spline.position_world_m) extent.extend(turn * point);
  return extent;
}

/// Scale factor with which the path fits at a heading; 1: unchanged.
double fit_of(const synthetic_imu::PoseSpline& camera, const Eigen::AlignedBox3d& box, double heading_rad) {
  const Vector3d size_m = extent_of(camera, heading_rad).sizes();
  return std::min(1.0, box.sizes().cwiseQuotient(size_m.cwiseMax(1e-9)).minCoeff());
}

/// Rotates the path, scales it down if necessary, and moves it into the box.
void place_in_box(const Eigen::AlignedBox3d& box, const HeadingTexture& texture, FileMotion& motion) {
  constexpr int kHeadings = 36;
  motion.heading_rad = texture.best_turn_rad(motion.camera);
  if (texture.face_rad) {
    Vector3d forward = Vector3d::Zero();
    for (const Quaterniond& rotation : motion.camera.rotation_world_body)
      forward += rotation * Vector3d::UnitZ();
    motion.heading_rad = *texture.face_rad - std::atan2(forward.y(), forward.x());
  }
  motion.shrunk = fit_of(motion.camera, box, motion.heading_rad);
  for (int i = 0; i < kHeadings; ++i) {
    const double heading_rad = radians(i * 360.0 / kHeadings);
    const double fits = fit_of(motion.camera, box, heading_rad);
    if (fits > motion.shrunk + 1e-9) {
      motion.shrunk = fits;
      motion.heading_rad = heading_rad;
    }
  }
  const Quaterniond turn(Eigen::AngleAxisd(motion.heading_rad, Vector3d::UnitZ()));
  const Vector3d middle = extent_of(motion.camera, motion.heading_rad).center();
  for (Vector3d& point : motion.camera.position_world_m) {
    point = box.center() + motion.shrunk * (turn * point - middle);
  }
  for (Quaterniond& rotation : motion.camera.rotation_world_body) rotation = (turn * rotation).normalized();
}

}  // namespace

Result<FilePath> read_file_path(const std::filesystem::path& file) {
  const auto columns = count_columns(file);
  if (!columns) return tl::unexpected(columns.error());
  FilePath path;
  const bool matrices = *columns == 13;
  auto poses = matrices ? read_matrices(file) : trajectory::read_tum_trajectory(file, path.warnings);
  if (!poses) return tl::unexpected(poses.error());
  if (poses->size() < 4) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: {} poses are too few (at least 4)", file.string(), poses->size()));
  }
  const auto is_far = [](const StampedPose& pose) {
    return !(pose.T_world_camera.translation.cwiseAbs().maxCoeff() <= kMost_m);
  };
  if (const auto far = std::ranges::find_if(*poses, is_far); far != poses->end()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: pose {}: a position beyond {:g} m", file.string(), far - poses->begin() + 1,
                            kMost_m),
                "metres are expected");
  }
  start_at_zero(*poses);
  if (matrices || file.filename().string().find(".gt.freiburg") != std::string::npos) {
    take_indices_as_frames(*poses);
    path.cutoff_hz = kIclCutoff_hz;
  }
  path.poses = std::move(*poses);
  return path;
}

Result<void> check_file_motion(const FileMotionOptions& options) {
  for (const auto& [name, value, low, high] :
       {std::tuple{"speed", options.speed, 0.05, 20.0}, std::tuple{"skip_s", options.skip_s, 0.0, 1e5},
        std::tuple{"rest_s", options.rest_s, 0.0, 60.0}, std::tuple{"start_s", options.start_s, 0.0, 10.0}}) {
    if (!(value >= low && value <= high)) {
      return fail(ErrorCode::configuration,
                  fmt::format("trajectory.{} = {} (allowed {} .. {})", name, value, low, high));
    }
  }
  return {};
}

double longest_duration_s(const FilePath& path, const FileMotionOptions& options, double lead_s) {
  const double moving_s = (path.length_s() - options.skip_s) / options.speed;
  // A smooth start covers half the path of its duration.
  const double before_s = options.from_rest ? -options.rest_s - 0.5 * options.start_s : lead_s;
  return moving_s - before_s - seconds_between(0, MotionSpan::kTail_ns);
}

Result<FileMotion> file_motion(const FilePath& path, const FileMotionOptions& options, const MotionSpan& span,
                               const Eigen::AlignedBox3d& box, const HeadingTexture& texture) {
  if (const auto valid = check_file_motion(options); !valid) return tl::unexpected(valid.error());
  const double lead_s = seconds_between(span.begin_ns, span.first_frame_ns);
  const double duration_s = seconds_between(span.first_frame_ns, span.last_frame_ns);
  const double longest_s = longest_duration_s(path, options, lead_s);
  if (duration_s > longest_s) {
    return fail(ErrorCode::configuration,
                fmt::format("duration_s = {:.3f} is longer than the trajectory (up to {:.3f} at speed {:g})",
                            duration_s, longest_s, options.speed),
                "take a shorter recording or a lower speed");
  }
  const PathClock clock = clock_for(options, lead_s);
  const auto smooth = smooth_path(path, clock.path_s(lead_s + duration_s));
  if (!smooth) return tl::unexpected(smooth.error());
  const auto pose_at = [&](double path_s) {
    return smooth->evaluate(std::llround(1e9 * path_s)).T_world_body;
  };
  FileMotion motion{spline_along(pose_at, clock, span)};
  if (!options.in_place) place_in_box(box, texture, motion);
  return motion;
}

}  // namespace fusebench::simulator::motion
