// .sens files of ScanNet and BundleFusion (Dai et al., CVPR 2017; TOG 2017) as recordings.
#pragma once

#include <filesystem>
#include <optional>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::sens {

/// A file whose name ends with .sens, or a folder that holds exactly one.
[[nodiscard]] bool is_sens(const std::filesystem::path& place);

/// Opens such a file. Colour is JPEG, PNG or plain, depth a zlib stream or plain. Calibration: the options',
/// calibration.toml beside the file, else the file's own; depth of other intrinsics, size or place is
/// registered to colour. Stamps: in the unit of their spacing; frames whose stamps do not rise with
/// the others' are left out, with a warning. Where a third and more do not rise, or there are no stamps,
/// frame k is at k / frame rate, with a note that has the reason. Poses are BundleFusion's estimate of the
/// same recording, and labelled so; without any, groundtruth.txt beside the file is used. Inertial frames:
/// those of the file, else imu.csv beside it. Errors: configuration, data_missing, data_corrupt (what
/// sens_log.hpp refuses, depth in the occipital codec).
[[nodiscard]] Result<recording::Recording> open_sens(const std::filesystem::path& place,
                                                     const recording::ReadOptions& options);

}  // namespace fusebench::formats::sens
