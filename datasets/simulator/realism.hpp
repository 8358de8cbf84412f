// Realistic sensors for any motion: simulated recordings with the difficulties of real ones.
#pragma once

#include "datasets/simulator/simulation.hpp"

namespace fusebench::simulator {

/// True if the preset has realistic sensors.
[[nodiscard]] bool is_realistic(motion::MotionPreset preset);

/// Sets the sensors of a low-cost camera and IMU without a good calibration, and the office instead of the
/// furnished room unless the preset has a route through that. The seed determines the device, so set it
/// before the call. realism.cpp has the constants and their sources.
void make_realistic(SimulationOptions& options);

/// Lines of simulation.toml for the options of make_realistic(); empty if they are off.
[[nodiscard]] std::string realism_text(const SimulationOptions& options);

}  // namespace fusebench::simulator
