// Faults of the images of a simulated recording: kind, time span and, for some kinds, an amount.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::simulator::faults {

enum class FaultKind { black, no_depth, no_texture, hand, person, brightness, drop, blur };

/// One row of the table of kinds.
struct FaultDescription {
  FaultKind kind;
  std::string_view name;
  std::string_view amount;  ///< meaning of the amount; empty: this kind has none, and the next three are 0
  double usual;             ///< default amount
  double least;
  double most;
  std::string_view sentence;
};
[[nodiscard]] std::span<const FaultDescription> fault_kinds();
[[nodiscard]] const FaultDescription& describe(FaultKind kind);

/// A fault applies to frames with begin_s <= stamp < end_s.
struct SimulatedFault {
  FaultKind kind = FaultKind::black;
  double begin_s = 0;  ///< begin_s and end_s are relative to the first frame
  double end_s = 0;
  double amount = 0;

  [[nodiscard]] bool holds_at(std::int64_t since_first_ns) const;
};

/// KIND=BEGIN:END or KIND=BEGIN:END:AMOUNT, e.g. "hand=1:2.5:0.4". Error usage: another form, an unknown
/// kind, an amount for a kind that has none.
[[nodiscard]] Result<SimulatedFault> parse_fault(std::string_view text);

/// Text that parse_fault() reads as the same fault.
[[nodiscard]] std::string to_string(const SimulatedFault& fault);

/// Errors (configuration) name the fault: times out of order, no frame within them, an amount out of range,
/// two faults of a kind at once, a hand and a person at once, an exposure longer than the frame interval, a
/// dropped first frame, fewer than two frames left. frame_ns: stamps, at least two.
[[nodiscard]] Result<void> check_faults(std::span<const SimulatedFault> faults,
                                        std::span<const std::int64_t> frame_ns);

/// Combined effect of all faults on one frame.
struct FrameFaults {
  bool black = false;
  bool no_depth = false;  ///< also set if black
  bool no_texture = false;
  bool dropped = false;
  double brightness = 1;
  std::optional<double> exposure_s;
  std::optional<std::size_t> hand;    ///< index of the fault; exclusive with person
  std::optional<std::size_t> person;  ///< index of the fault
};
[[nodiscard]] FrameFaults faults_at(std::span<const SimulatedFault> faults, std::int64_t since_first_ns);

/// True for each frame that is dropped.
[[nodiscard]] std::vector<bool> dropped_frames(std::span<const SimulatedFault> faults,
                                               std::span<const std::int64_t> frame_ns);

}  // namespace fusebench::simulator::faults
