// The groups of checks. Each writes its measurements and findings into the inspection; the order in which
// inspect() calls them matters, since later ones read what earlier ones measured.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "datasets/inspection/inspection.hpp"
#include "datasets/inspection/measures/force_windows.hpp"

namespace fusebench::inspection {

/// Rates, gaps, duplicates, order and units of the frames' stamps, and how depth belongs to colour.
void check_frame_stamps(const recording::Recording& recording, Inspection& out);
/// The same of the ground truth, and how it covers the frames.
void check_truth_stamps(const recording::Recording& recording, Inspection& out);
/// The same of the IMU.
void check_imu_stamps(const recording::Recording& recording, Inspection& out);

/// Frames whose files have the bytes of the frame before. Needs motion.
void check_repeated_images(const recording::Recording& recording, Inspection& out);

/// Loads sampled frames: exposure, sharpness, depth.
void check_images(const recording::Recording& recording, const Workers& workers,
                  const InspectOptions& options, Inspection& out);
/// Whether edges of depth lie on edges of colour. Needs images.
void check_registration(const recording::Recording& recording, const Workers& workers, Inspection& out);

/// Whether the ground truth stands still while the images move.
void check_truth_moves(const recording::Recording& recording, const Workers& workers, Inspection& out);

/// Speeds and predicted blur. Needs the median depth of images.
void check_motion(const recording::Recording& recording, Inspection& out);

/// Spikes of the IMU and values beyond its range. Returns the recording without these samples if there are
/// any: checks of values and fits must not see them. Needs the stamps of the IMU.
[[nodiscard]] std::optional<recording::Recording> leave_out_imu_faults(const recording::Recording& recording,
                                                                       Inspection& out);

/// Saturation, repeated values and units of the IMU; gravity and biases at rest.
void check_imu_values(const recording::Recording& recording, Inspection& out);
/// Time offset, axes, scale and gyroscope bias against the camera's turns: those of the ground truth, if no
/// error was found in it so far, else those of the images. Needs the checks of the ground truth and its
/// warping.
void check_imu_alignment(const recording::Recording& recording, const Workers& workers,
                         const InspectOptions& options, Inspection& out);
/// Axes of gyroscope and accelerometer, each on its own. Needs the alignment.
void check_imu_axes(const recording::Recording& recording, Inspection& out);
/// Gravity and accelerometer bias against ground truth. Needs the axes.
void check_accelerometer(const recording::Recording& recording, Inspection& out);

/// Frames warped by ground truth, and what would make them fit better. Needs images.
void check_reprojection(const recording::Recording& recording, const Workers& workers,
                        const InspectOptions& options, Inspection& out);

/// Measures one list of stamps.
[[nodiscard]] StampMeasurement measure_stamps(std::span<const std::int64_t> stamps_ns);

/// The longest interval between two poses of the ground truth that is still interpolated: 0.1 s, or two and a
/// half median intervals of a sparser truth.
[[nodiscard]] std::int64_t truth_gap_ns(const recording::Recording& recording);

/// Whether the poses, by what was found so far, are those of the camera at their stamps.
[[nodiscard]] bool truth_is_usable(const Inspection& out);

/// The path of the IMU's axes, as they are calibrated or, if it is measured well, as the turns show.
[[nodiscard]] measures::TruePath true_path(const recording::Recording& recording, const Inspection& out);

/// Whether the frames' stamps are in seconds, and so speeds mean something.
[[nodiscard]] bool times_are_plausible(const Inspection& out);

}  // namespace fusebench::inspection
