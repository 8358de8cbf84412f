// Writers of the text files of simulated recordings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/simulator/layouts/layout.hpp"

namespace fusebench::simulator::layouts {

/// Writes a whole text file. Error io.
[[nodiscard]] Result<void> write_text(const std::filesystem::path& file, std::string_view text);

/// Writes imu.csv with EuRoC's columns: ns, rad/s, m/s^2.
[[nodiscard]] Result<void> write_imu_csv(const std::filesystem::path& file,
                                         const std::vector<ImuSample>& samples);

/// Writes the columns of EuRoC's state_groundtruth_estimate0, in the world frame of the files.
[[nodiscard]] Result<void> write_states(const std::filesystem::path& file,
                                        const std::vector<sensors::ImuState>& states,
                                        const SE3& T_file_scene);

// TUM RGB-D: rgb/, depth/ by seconds, rgb.txt, depth.txt, associations.txt (rgb first), groundtruth.txt,
// imu.csv.
[[nodiscard]] std::string tum_color_name(std::size_t frame, std::int64_t frame_ns);
[[nodiscard]] std::string tum_depth_name(std::size_t frame, std::int64_t frame_ns);
[[nodiscard]] Result<void> write_tum_lists(const std::filesystem::path& folder, const SimulatedData& data);

// ICL-NUIM, TUM-compatible packing: rgb/, depth/ by index, associations.txt (depth first),
// livingRoom0.gt.freiburg from frame 1 on, imu.csv with frame k at k / 30 s. As published, poses are relative
// to the camera of frame 1, 2.25 m before the origin, and reflected: left-handed with y up. The right-handed
// world of the files is its reflection, with y down.
[[nodiscard]] std::string icl_color_name(std::size_t frame, std::int64_t frame_ns);
[[nodiscard]] std::string icl_depth_name(std::size_t frame, std::int64_t frame_ns);
[[nodiscard]] Result<void> write_icl_lists(const std::filesystem::path& folder, const SimulatedData& data);
[[nodiscard]] SE3 icl_T_file_scene(const SimulatedData& data);

// FMDataset: color/, depth/ by microseconds, TIMESTAMP.txt, IMU.txt in microseconds, groundtruth.txt.
[[nodiscard]] std::string zr300_color_name(std::size_t frame, std::int64_t frame_ns);
[[nodiscard]] std::string zr300_depth_name(std::size_t frame, std::int64_t frame_ns);
[[nodiscard]] Result<void> write_zr300_lists(const std::filesystem::path& folder, const SimulatedData& data);

}  // namespace fusebench::simulator::layouts
