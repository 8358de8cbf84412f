// InfiniTAM's input (Kaehler et al., TVCG 2015): numbered images and a calibration file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "core/base/image.hpp"
#include "datasets/exports/export_place.hpp"
#include "datasets/exports/export_summary.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::exports {

/// Millimetres; its reader takes larger values for no measurement.
inline constexpr DepthStorage kInfinitamDepth{1000, 32000};
inline constexpr std::string_view kInfinitamColorMask = "color/%04i.ppm";
inline constexpr std::string_view kInfinitamDepthMask = "depth/%04i.pgm";

/// color/%04i.ppm (8-bit RGB) and depth/%04i.pgm (16-bit mm) from 0, calib.txt (colour and depth of one
/// camera, identity between them, "affine 0.001 0": the layout of infinitam_calibration.hpp), and
/// frame_times.txt. No mask of inertial files: with one, the reader expects raw images of another size.
/// Errors: those of the recording, io.
[[nodiscard]] Result<WrittenExport> write_infinitam(const recording::Recording& recording,
                                                    const ExportPlace& place);

/// The name that a printf mask with one %i or %d gives ("color/%04i.ppm", 7: "color/0007.ppm"). Error usage:
/// another mask.
[[nodiscard]] Result<std::string> masked_name(std::string_view mask, std::size_t index);

struct InfinitamFrame {
  ColorImage color;
  Image<std::uint16_t> depth_mm;  ///< 0 = no measurement
};

/// Reads the images (ppm, pgm) that the masks give for an index; nothing if neither is there, as after the
/// last frame. Errors: usage (a mask), data_missing (one of the two), data_corrupt.
[[nodiscard]] Result<std::optional<InfinitamFrame>> read_infinitam_frame(const std::string& color_mask,
                                                                         const std::string& depth_mask,
                                                                         std::size_t index);

}  // namespace fusebench::exports
