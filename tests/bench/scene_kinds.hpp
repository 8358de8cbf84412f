// The scenes of the benchmarks by kind, without what is in them.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/error.hpp"

namespace fusebench::testing {

struct BenchScene;

enum class SceneKind : std::int64_t { room = 0, recording = 1 };

/// Made once. The room: 67 degrees of view at a width of 320 or 640 pixels, three near views, the last of
/// which is the frame, rendered. The recording: 640 pixels, frame 30 of it, and the 30 frames before that as
/// the estimator tracked and fused them with a synthetic IMU. What cannot be read or tracked throws
/// (check()).
[[nodiscard]] const BenchScene& bench_scene(SceneKind kind, int width_px);

/// The folder of the recording below FUSEBENCH_DATA, or why there is none (data_missing).
[[nodiscard]] Result<std::filesystem::path> recorded_folder();

}  // namespace fusebench::testing
