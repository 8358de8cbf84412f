// The models of a recording's runs beside each other, with the ways of their cameras.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_series.hpp"

namespace fusebench::report {

/// Of the runs that have a surface, each in the frame of its first camera, with at most so many triangles (or
/// surfels) and poses. Coloured by the error where there is a true surface. Adds to warnings what cannot be
/// read.
[[nodiscard]] page::PageScene model_scene(std::span<const RunSeries> runs, std::size_t most_triangles,
                                          std::size_t most_poses, std::vector<std::string>& warnings);

}  // namespace fusebench::report
