#include "datasets/recording/formats/euroc/euroc_folder.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "datasets/recording/formats/euroc/euroc_sensors.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/reading/image_pairs.hpp"
#include "datasets/recording/reading/image_recording.hpp"
#include "datasets/recording/reading/side_files.hpp"
#include "datasets/recording/sensor_columns.hpp"
#include "datasets/recording/state_truth.hpp"

namespace fusebench::formats::euroc {

namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 1000;
constexpr std::string_view kPoseColumns = "timestamp px py pz qw qx qy qz [vx vy vz bwx bwy bwz bax bay baz]";
constexpr std::size_t kColumnsOfStates = 17;

/// The folder of the sensors' folders.
fs::path sensors_folder(const fs::path& folder) {
  return io::is_named(folder / "mav0") ? folder / "mav0" : folder;
}

Result<void> read_frames(const fs::path& mav0, const recording::ReadOptions& options,
                         recording::Recording& recording) {
  if (!io::is_named(mav0 / "depth0" / "data.csv")) {
    return fail(
        ErrorCode::data_missing, fmt::format("{}: there is no depth0/data.csv beside cam0", mav0.string()),
        "depth images are needed: EuRoC's own recordings are stereo, and a program that computes depth "
        "from them writes depth0/data.csv (\"timestamp [ns],filename\") and depth0/data/ "
        "(16-bit PNG, mm)");
  }
  const auto listed = [&](const char* sensor) {
    return reading::read_image_list(mav0 / sensor / "data.csv", mav0 / sensor / "data",
                                    io::TimeUnit::nanoseconds, recording.warnings);
  };
  const auto color = listed("cam0");
  if (!color) return tl::unexpected(color.error());
  const auto depth = listed("depth0");
  if (!depth) return tl::unexpected(depth.error());
  return reading::pair_images({"cam0/data.csv", *color}, {"depth0/data.csv", *depth}, options, recording);
}

/// What the rows of state_groundtruth_estimate0/data.csv are.
struct BodyTruth {
  Trajectory T_world_body;
  bool has_states = false;
};

Result<BodyTruth> read_body_poses(const fs::path& file) {
  BodyTruth truth;
  const auto row = [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    const auto position_m = recording::read_position(table, 1, "p");
    if (!position_m) return tl::unexpected(position_m.error());
    std::array<double, 4> q{};
    if (const auto read = table.numbers(4, q); !read) return tl::unexpected(read.error());
    const Quaterniond rotation(q[0], q[1], q[2], q[3]);
    if (!(rotation.norm() > 0.5 && rotation.norm() < 2))
      return table.fail_here("the quaternion (qw qx qy qz) is not of unit length");
    truth.T_world_body.push_back({time_ns, {rotation.normalized(), *position_m}});
    truth.has_states = table.has(kColumnsOfStates - 1);
    return {};
  };
  const auto done =
      io::for_each_stamped_row(file, kPoseColumns, io::TimeOrder::increasing, row, io::TimeUnit::nanoseconds);
  if (!done) return tl::unexpected(done.error());
  return truth;
}

Result<void> read_truth(const fs::path& mav0, const std::optional<EurocRig>& rig,
                        recording::Recording& recording) {
  const fs::path file = mav0 / "state_groundtruth_estimate0" / "data.csv";
  if (!io::is_named(file)) return {};
  if (!rig) {
    recording.warnings.push_back(
        fmt::format("{}: not used, since it is of the body and cam0/sensor.yaml, which says where the camera "
                    "is in it, cannot "
                    "be read",
                    file.string()));
    return {};
  }
  auto truth = read_body_poses(file);
  if (!truth) return tl::unexpected(truth.error());
  for (StampedPose& pose : truth->T_world_body) pose.T_world_camera = pose.T_world_camera * rig->T_body_color;
  if (truth->has_states && rig->imu_is_body) {
    auto states = recording::read_state_truth(file);
    if (!states) return tl::unexpected(states.error());
    recording.state_truth = std::move(*states);
  }
  return reading::set_ground_truth(recording, std::move(truth->T_world_body), file);
}

Result<void> read_imu(const fs::path& mav0, recording::Recording& recording) {
  const fs::path file = mav0 / "imu0" / "data.csv";
  if (!io::is_named(file)) return {};
  auto samples = reading::read_imu_table(file, io::TimeUnit::nanoseconds);
  if (!samples) return tl::unexpected(samples.error());
  recording.imu = std::move(*samples);
  recording.imu_source = recording::ImuSource::recorded;
  return {};
}

}  // namespace

bool is_euroc(const fs::path& folder) { return io::is_named(sensors_folder(folder) / "cam0" / "data.csv"); }

Result<recording::Recording> open_euroc(const fs::path& folder, const recording::ReadOptions& options) {
  recording::Recording recording = recording::named_recording(folder, "euroc");
  if (const auto valid = recording::check_read_options(options); !valid) return tl::unexpected(valid.error());
  const fs::path mav0 = sensors_folder(folder);
  const auto rig = read_euroc_rig(mav0);
  auto calibration = recording::choose_calibration(
      folder, options,
      [&]() -> Result<calibration::RigCalibration> {
        if (!rig) return tl::unexpected(rig.error());
        return rig->calibration;
      },
      recording);
  if (!calibration) return tl::unexpected(calibration.error());
  if (const auto read = read_frames(mav0, options, recording); !read) return tl::unexpected(read.error());
  if (const auto read = read_truth(mav0, rig ? std::optional(*rig) : std::nullopt, recording); !read)
    return tl::unexpected(read.error());
  if (const auto read = read_imu(mav0, recording); !read) return tl::unexpected(read.error());
  const double units = reading::settled_depth_units(*calibration, kUnitsPerMetre);
  const auto attached = reading::attach_images(
      recording, {std::move(*calibration), reading::png_depth(units), fmt::format("png {}", units)});
  if (!attached) return tl::unexpected(attached.error());
  return recording;
}

}  // namespace fusebench::formats::euroc
