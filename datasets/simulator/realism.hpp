// Sensors as they are rather than as their data sheets say, for any motion: what makes a simulated recording
// as hard as a real one.
#pragma once

#include "datasets/simulator/simulation.hpp"

namespace fusebench::simulator {

/// Whether a preset is of recordings with realistic sensors.
[[nodiscard]] bool is_realistic(motion::MotionPreset preset);

/// Gives the options the sensors of a cheap camera and IMU that nobody has calibrated well, in the office
/// instead of the furnished room, unless the preset follows a route through that; the seed of the options
/// chooses the device. To be called once the seed is set. Constants and what they were measured on:
/// realism.cpp.
void make_realistic(SimulationOptions& options);

/// The lines of simulation.toml about what make_realistic() switches on; nothing for what is off.
[[nodiscard]] std::string realism_text(const SimulationOptions& options);

}  // namespace fusebench::simulator
