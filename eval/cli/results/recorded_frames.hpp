// Images of the recordings of runs, for reports.
#pragma once

#include <filesystem>

#include "eval/report/frame_pictures.hpp"

namespace fusebench::cli::results {

/// data: folder in which recordings are searched by their recorded names; simulated ones are also searched
/// next to the folder of runs, above it and in results/simulated, where `bench` writes them. Errors of the
/// reader: data_missing if the recording does not exist or has other content; those of reading it.
[[nodiscard]] report::FrameReader recorded_frames(const std::filesystem::path& data,
                                                  const std::filesystem::path& runs);

}  // namespace fusebench::cli::results
