// Optional files beside the images of any format, for data that the format itself does not cover.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// groundtruth.txt: TUM columns, seconds on the images' clock, T_groundtruth_camera of the colour camera.
/// Fills recording.ground_truth; warns about frames that it does not cover. Leaves a recording without that
/// file alone. Errors: data_corrupt (a row, the order in time, a position beyond 1e7 m, no overlap with the
/// images in time).
[[nodiscard]] Result<void> read_ground_truth_beside(const std::filesystem::path& folder,
                                                    recording::Recording& recording);

/// Puts a truth into the recording that was read elsewhere; the same checks. `source` names the file in
/// messages. published_without: frames at the beginning for which the format publishes no pose, which is
/// worth a note and no warning.
[[nodiscard]] Result<void> set_ground_truth(recording::Recording& recording, Trajectory truth,
                                            const std::filesystem::path& source,
                                            std::size_t published_without = 0);

/// Marks the ground truth, which is set apart, as estimated from the recording itself, and notes it. label:
/// begins with kPseudoTruthBeginning, and says by whom.
void label_truth(std::string_view label, recording::Recording& recording);

/// Inertial samples as text: "timestamp wx wy wz ax ay az", rad/s and m/s^2, on the IMU's clock. Errors:
/// data_missing, data_corrupt (a row, the order in time, a value beyond the limits of sensor_columns.hpp).
[[nodiscard]] Result<std::vector<ImuSample>> read_imu_table(const std::filesystem::path& file,
                                                            io::TimeUnit unit);

/// imu.csv: EuRoC columns, "timestamp [ns], wx, wy, wz [rad/s], ax, ay, az [m/s^2]", on the IMU's clock.
/// Fills recording.imu and imu_source. Errors: data_corrupt.
[[nodiscard]] Result<void> read_imu_beside(const std::filesystem::path& folder,
                                           recording::Recording& recording);

/// state_groundtruth.csv (state_truth.hpp; on the images' clock) and scene.ply (a mesh in the world of the
/// ground truth, which is not opened here). Fills recording.state_truth and truth_mesh_file. Errors:
/// data_corrupt.
[[nodiscard]] Result<void> read_exact_truth_beside(const std::filesystem::path& folder,
                                                   recording::Recording& recording);

/// Marks a simulated recording by being there: in the recording's folder, or beside a file that is one, as
/// NAME.simulation.toml beside NAME.sens.
inline constexpr std::string_view kSimulationFile = "simulation.toml";

/// Looks for that file by the recording's name. Sets recording.simulated.
void note_simulation(const std::filesystem::path& folder, recording::Recording& recording);

}  // namespace fusebench::reading
