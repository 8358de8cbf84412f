// What goes wrong with the images of a simulated recording, and when: a closed list of kinds, each with an
// amount where it has one.
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
  std::string_view amount;  ///< what the amount is; empty: this kind has none, and the next three are 0
  double usual;             ///< the amount if none is given
  double least;
  double most;
  std::string_view sentence;
};
[[nodiscard]] std::span<const FaultDescription> fault_kinds();
[[nodiscard]] const FaultDescription& describe(FaultKind kind);

/// One fault: it holds for frames whose stamp is at begin_s or later, and before end_s.
struct SimulatedFault {
  FaultKind kind = FaultKind::black;
  double begin_s = 0;  ///< these two: from the stamp of the first frame
  double end_s = 0;
  double amount = 0;

  [[nodiscard]] bool holds_at(std::int64_t since_first_ns) const;
};

/// KIND=BEGIN:END or KIND=BEGIN:END:AMOUNT, e.g. "hand=1:2.5:0.4". Error usage: another form, an unknown
/// kind, an amount for a kind that has none.
[[nodiscard]] Result<SimulatedFault> parse_fault(std::string_view text);

/// The text that parse_fault reads as the same fault.
[[nodiscard]] std::string to_string(const SimulatedFault& fault);

/// Errors (configuration) name the fault: times out of order, no frame within them, an amount out of range,
/// two faults of a kind at once, a hand beside a person, an exposure longer than from frame to frame, a first
/// frame that is dropped, fewer than two frames left. frame_ns: stamps, at least two.
[[nodiscard]] Result<void> check_faults(std::span<const SimulatedFault> faults,
                                        std::span<const std::int64_t> frame_ns);

/// What all faults together make of one frame.
struct FrameFaults {
  bool black = false;
  bool no_depth = false;  ///< also if black
  bool no_texture = false;
  bool dropped = false;
  double brightness = 1;
  std::optional<double> exposure_s;
  std::optional<std::size_t> hand;    ///< index of the fault; never beside a person
  std::optional<std::size_t> person;  ///< index of the fault
};
[[nodiscard]] FrameFaults faults_at(std::span<const SimulatedFault> faults, std::int64_t since_first_ns);

/// By frame, whether it is missing.
[[nodiscard]] std::vector<bool> dropped_frames(std::span<const SimulatedFault> faults,
                                               std::span<const std::int64_t> frame_ns);

}  // namespace fusebench::simulator::faults
