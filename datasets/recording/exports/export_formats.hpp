// The formats that recordings are exported in: how each stores depth, and what its files hold.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "datasets/recording/exports/export_place.hpp"
#include "datasets/recording/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

inline constexpr DepthStorage kTumDepth{5000, 65535};  ///< up to 13.1 m
/// TUM RGB-D's layout (Sturm et al., IROS 2012), which ORB-SLAM2 and 3, supereight2 and this program read:
/// rgb/ and depth/ (PNG: 8-bit RGB; 16-bit, 5000 = 1 m) named by their stamps in seconds with nine decimals;
/// rgb.txt, depth.txt; associations.txt ("t rgb t depth"); groundtruth.txt (T_groundtruth_camera) if the
/// recording has a truth; imu.csv, accelerometer.txt, state_groundtruth.csv (where there is such data) and
/// calibration.toml, with which this program reads all of it back but the scene's mesh;
/// orbslam3.yaml. Errors: those of the recording, io, and data_corrupt (two images of one stamp).
[[nodiscard]] Result<WrittenExport> write_tum(const recording::Recording& recording,
                                              const ExportPlace& place);

/// Millimetres; its reader takes larger values for no measurement.
inline constexpr DepthStorage kInfinitamDepth{1000, 32000};
/// InfiniTAM's input (Kaehler et al., TVCG 2015): color/%04i.ppm (8-bit RGB) and depth/%04i.pgm (16-bit mm)
/// from 0, calib.txt (colour and depth of one camera, identity between them, "affine 0.001 0": the layout of
/// infinitam_calibration.hpp), and frame_times.txt. No mask of inertial files: with one, the reader expects
/// raw images of another size. Errors: those of the recording, io.
[[nodiscard]] Result<WrittenExport> write_infinitam(const recording::Recording& recording,
                                                    const ExportPlace& place);

inline constexpr DepthStorage kKlgDepth{1000, 65535};
/// ElasticFusion numbers frames with 16 bits.
inline constexpr std::size_t kKlgMostFrames = 65535;
/// .klg logs for ElasticFusion and Kintinuous (Whelan et al., IJRR 2016): NAME.klg and NAME.calibration.txt
/// (one line, "fx fy cx cy" in pixels). Depth is packed, colour plain, so that both come back as they are.
/// The last frame is written twice: the reader stops one frame early. Errors: those of the recording, io,
/// usage (images of another size).
[[nodiscard]] Result<WrittenExport> write_klg(const recording::Recording& recording,
                                              const ExportPlace& place);

inline constexpr DepthStorage kSensDepth{1000, 65535};
inline constexpr std::size_t kSensMostFrames = 12000;  ///< BundleFusion refuses more
/// .sens files for BundleFusion and readers of ScanNet: NAME.sens with colour as JPEG of quality 95 (lossy:
/// readers of ScanNet's files take no other), depth as zlib streams of millimetres, stamps in microseconds,
/// both cameras that of the recording, no poses, no IMU frames. Errors: those of the recording, of
/// images::encode_jpeg, io.
[[nodiscard]] Result<WrittenExport> write_sens(const recording::Recording& recording,
                                               const ExportPlace& place);

inline constexpr DepthStorage kOpen3dDepth{1000, 65535};
/// The input of Open3D's reconstruction system (Choi et al., CVPR 2015; run_system.py): color/%06d.png (8-bit
/// RGB) and depth/%06d.png (16-bit, mm) from 0: the program pairs them by the order of their names.
/// intrinsic.json (K column by column), config.json (depth_scale; paths relative to the folder, in which the
/// program is to be started), frame_times.txt. Errors: those of the recording, io.
[[nodiscard]] Result<WrittenExport> write_open3d(const recording::Recording& recording,
                                                 const ExportPlace& place);

inline constexpr DepthStorage kEurocDepth{1000, 65535};
/// EuRoC MAV's layout (Burri et al., IJRR 2016), which visual-inertial systems read:
/// mav0/cam0/data/STAMP.png (8-bit grey, STAMP in nanoseconds) and data.csv ("timestamp [ns],filename");
/// mav0/depth0 of the same names (16-bit mm; no part of EuRoC); mav0/imu0/data.csv (rad/s, m/s^2);
/// mav0/state_groundtruth_estimate0/data.csv of the IMU (without one: of the camera), all 17 columns where
/// the recording has true states and the first eight where it has poses; sensor.yaml of each sensor (T_BS:
/// sensor to body, and the IMU is the body); times.txt (a stamp a line) and orbslam3.yaml. Errors: those of
/// the recording, io.
[[nodiscard]] Result<WrittenExport> write_euroc(const recording::Recording& recording,
                                                const ExportPlace& place);

}  // namespace fusebench::exports
