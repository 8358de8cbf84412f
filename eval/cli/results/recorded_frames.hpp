// Images of the recordings that runs are of, for their report.
#pragma once

#include <filesystem>

#include "eval/report/frame_pictures.hpp"

namespace fusebench::cli::results {

/// data: the folder of recordings, which are looked for there by the names that records have; simulated ones
/// also beside the folder of runs, where `bench` puts them. Errors of the reader: data_missing if the
/// recording is not there, or another one; those of reading it.
[[nodiscard]] report::FrameReader recorded_frames(const std::filesystem::path& data,
                                                  const std::filesystem::path& runs);

}  // namespace fusebench::cli::results
