// The models of a recording's runs and the paths of their cameras, which can be turned.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::report {

/// How much of each run is shown.
struct SceneDetail {
  std::size_t triangles = 0;  ///< of its model, at most
  std::size_t poses = 0;      ///< of its path, about
  int picture_width_px = 0;   ///< of its picture on the page, at most
};

/// Receives the picture of a run's model at its full size (model_picture()).
using PictureTaker = std::function<void(const run_charts::RunSeries& run, const ColorImage& picture)>;

/// Every model in the frame of its first camera, reduced, with its errors as colours where the true scene is
/// known, and its picture. Runs without a model are left out; a model that cannot be read is, with a warning.
[[nodiscard]] page::PageScene model_scene(std::span<const run_charts::RunSeries> runs,
                                          const SceneDetail& detail, const PictureTaker& take_picture,
                                          std::vector<std::string>& warnings);

}  // namespace fusebench::report
