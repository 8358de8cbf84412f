#include <algorithm>
#include <array>

#include "datasets/simulator/motion/motion.hpp"

namespace fusebench::simulator::motion {

namespace {

struct PresetDescription {
  MotionPreset preset = MotionPreset::slow;
  std::string_view name;
  double usual_duration_s = 10;
};

// In the order of the enumeration. The durations of routes cover the whole route.
constexpr std::array<PresetDescription, 13> kPresets = {
    {{MotionPreset::slow, "slow"},
     {MotionPreset::fast, "fast"},
     {MotionPreset::shake, "shake"},
     {MotionPreset::sweep, "sweep"},
     {MotionPreset::realistic_scan, "realistic_scan", 60},
     {MotionPreset::realistic_turns, "realistic_turns", 60},
     {MotionPreset::realistic_revisit, "realistic_revisit", 60},
     {MotionPreset::loop_room, "loop_room", 33},
     {MotionPreset::loop_flat, "loop_flat", 120},
     {MotionPreset::corridor, "corridor", 90},
     {MotionPreset::shake_revisit, "shake_revisit", 60},
     {MotionPreset::twin_rooms, "twin_rooms", 70},
     {MotionPreset::no_loop, "no_loop", 58}}};

const PresetDescription& describe(MotionPreset preset) { return kPresets[static_cast<std::size_t>(preset)]; }

MotionOptions fast_motion() {
  MotionOptions options;
  options.peak_speed_mps = 2.0;
  options.peak_rate_radps = 3.0;
  options.position_hz = {0.3, 0.8};
  options.rotation_hz = {0.2, 0.7};
  options.pan_share = 0.6;
  return options;
}

MotionOptions shaking_motion() {
  MotionOptions options;
  options.peak_speed_mps = 1.2;
  options.peak_rate_radps = 2.5;
  options.shake_share = 0.75;
  return options;
}

MotionOptions sweeping_motion() {
  MotionOptions options;
  options.peak_speed_mps = 2.0;
  options.peak_rate_radps = 1.0;
  options.position_hz = {0.25, 0.6};
  options.rotation_hz = {0.3, 0.8};
  options.sideways = true;
  return options;
}

/// With the tremor of a hand that holds an object: 5 to 10 Hz, some tenths of a millimetre and of a degree.
MotionOptions trembling_motion() {
  MotionOptions options;
  options.tremor_m = 3e-4;
  options.tremor_rad = 1.2e-3;
  options.tremor_hz = {5, 10};
  return options;
}

MotionOptions realistic_motion(MotionPreset preset) {
  MotionOptions options = trembling_motion();
  options.peak_speed_mps = preset == MotionPreset::realistic_scan ? 0.5 : 0.8;
  options.peak_rate_radps = 0.8;
  options.mean_pitch_rad = radians(preset == MotionPreset::realistic_revisit ? -15.0 : -28.0);
  if (preset == MotionPreset::realistic_turns) {
    options.peak_rate_radps = 7;
    options.pan_share = 0.92;
    options.pans = {{2.0, 5.0}, {0.3, 0.55}, {1.0, 2.0}};
  } else if (preset == MotionPreset::realistic_revisit) {
    options.peak_rate_radps = 1.2;
    options.revisit_s = 20;
  }
  return options;
}

MotionOptions route_motion(MotionPreset preset) {
  MotionOptions options = trembling_motion();
  options.peak_speed_mps = 0.8;
  options.peak_rate_radps = preset == MotionPreset::shake_revisit ? 7.0 : 1.2;
  options.position_hz = {0.2, 0.6};
  options.rotation_hz = {0.15, 0.5};
  options.mean_pitch_rad = radians(preset == MotionPreset::shake_revisit ? -26.0 : -18.0);
  return options;
}

}  // namespace

std::string_view to_string(MotionPreset preset) { return describe(preset).name; }

std::span<const MotionPreset> motion_presets() {
  static constexpr auto kAll = [] {
    std::array<MotionPreset, kPresets.size()> all{};
    std::ranges::transform(kPresets, all.begin(), &PresetDescription::preset);
    return all;
  }();
  return kAll;
}

double usual_duration_s(MotionPreset preset) { return describe(preset).usual_duration_s; }

bool follows_route(MotionPreset preset) { return preset >= MotionPreset::loop_room; }

MotionOptions motion_preset(MotionPreset preset) {
  switch (preset) {
    case MotionPreset::slow:
      return {};
    case MotionPreset::fast:
      return fast_motion();
    case MotionPreset::shake:
      return shaking_motion();
    case MotionPreset::sweep:
      return sweeping_motion();
    case MotionPreset::realistic_scan:
    case MotionPreset::realistic_turns:
    case MotionPreset::realistic_revisit:
      return realistic_motion(preset);
    default:
      return route_motion(preset);
  }
}

}  // namespace fusebench::simulator::motion
