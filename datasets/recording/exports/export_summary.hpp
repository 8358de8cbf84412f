// What an export wrote, for the user and for whoever starts the program that reads it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench::exports {

/// A format, by what reads it: TUM RGB-D (ORB-SLAM2 and 3, and this program), InfiniTAM, ElasticFusion
/// (.klg), BundleFusion (.sens), Open3D's reconstruction system, EuRoC MAV (visual-inertial systems).
enum class ExportFormat { tum, infinitam, klg, sens, open3d, euroc };
[[nodiscard]] std::string_view to_string(ExportFormat format);  ///< "tum", "infinitam", ...

/// How a format stores z-depth: unsigned 16-bit values, 0 where there is no measurement.
struct DepthStorage {
  double units_per_metre = 1000;
  std::uint16_t most = 65535;  ///< the largest value that its reader takes for a measurement

  [[nodiscard]] double farthest_m() const { return most / units_per_metre; }
};

struct DepthCounts {
  std::uint64_t measured = 0;      ///< pixels with depth in the recording
  std::uint64_t beyond_range = 0;  ///< of them, those that the format cannot store: written as 0
};

/// What one format wrote; the files are relative to the place of the export.
struct WrittenExport {
  DepthCounts depth;
  std::vector<std::filesystem::path> files;  ///< that the other program is told
  std::vector<std::string> notes;            ///< for who starts it
  std::filesystem::path calibration = {};    ///< of the files, the one that holds the camera; empty: none
};

struct ExportSummary {
  ExportFormat format = ExportFormat::tum;
  std::filesystem::path out;
  std::size_t frames = 0;  ///< of the recording
  DepthStorage depth_storage;
  DepthCounts depth;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> notes;
  std::filesystem::path
      calibration;  ///< where the camera is told, absolute or relative like `out`; empty: nowhere
};

}  // namespace fusebench::exports
