#include "datasets/simulator/faults/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/types.hpp"

namespace fusebench::simulator::faults {

namespace {

constexpr std::array<FaultDescription, 8> kKinds = {{
    {FaultKind::black, "black", "", 0, 0, 0, "no light reaches the colour camera, and there is no depth"},
    {FaultKind::no_depth, "no-depth", "", 0, 0, 0, "depth images are empty"},
    {FaultKind::no_texture, "no-texture", "", 0, 0, 0, "every surface is of one matt grey"},
    {FaultKind::hand, "hand", "share of the colour image", 0.5, 0.02, 0.9,
     "a textured thing moves 0.4 m before the camera"},
    {FaultKind::person, "person", "distance in metres", 1.5, 0.5, 5,
     "a person walks through the view at 1 m/s, before the camera halfway"},
    {FaultKind::brightness, "brightness", "factor on all light", 0.5, 0.05, 10,
     "the colour camera's gain jumps"},
    {FaultKind::drop, "drop", "", 0, 0, 0, "frames are missing"},
    {FaultKind::blur, "blur", "exposure in seconds", 0.03, 0.001, 0.1,
     "colour images are exposed for longer, at the same brightness"},
}};

constexpr std::string_view kForm = "KIND=BEGIN:END[:AMOUNT], e.g. --fault hand=1:2.5:0.4";

std::string names_of_kinds() {
  std::string names;
  for (const FaultDescription& kind : kKinds) {
    if (!names.empty()) names += ", ";
    names += kind.name;
  }
  return names;
}

Result<FaultKind> kind_of(std::string_view name, std::string_view whole) {
  const auto* const found = std::ranges::find(kKinds, name, &FaultDescription::name);
  if (found != kKinds.end()) return found->kind;
  return fail(ErrorCode::usage,
              fmt::format("fault {}: kind = {} (allowed: {})", whole, name, names_of_kinds()),
              fmt::format("faults are {}", kForm));
}

Result<double> number_of(std::string_view text, std::string_view whole) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc{} && read.ptr == text.data() + text.size() && std::isfinite(value)) return value;
  return fail(ErrorCode::usage, fmt::format("fault {}: '{}' is no number", whole, text),
              fmt::format("faults are {}", kForm));
}

/// Validates a single fault; returns the complaint or an empty text.
std::string complaint(const SimulatedFault& fault, std::span<const std::int64_t> frame_ns) {
  const FaultDescription& kind = describe(fault.kind);
  const double last_s = seconds_between(frame_ns.front(), frame_ns.back());
  if (!(fault.begin_s >= 0 && fault.end_s > fault.begin_s && std::isfinite(fault.end_s)))
    return "begins before the first frame, or does not end after its beginning";
  if (!kind.amount.empty() && !(fault.amount >= kind.least && fault.amount <= kind.most))
    return fmt::format("{} = {} (allowed {} .. {})", kind.amount, fault.amount, kind.least, kind.most);
  const double spacing_s = seconds_between(frame_ns[0], frame_ns[1]);
  if (fault.kind == FaultKind::blur && fault.amount > spacing_s)
    return fmt::format("exposure = {} s, longer than the {:.4g} s from frame to frame", fault.amount,
                       spacing_s);
  const bool holds = std::ranges::any_of(
      frame_ns, [&](std::int64_t t_ns) { return fault.holds_at(t_ns - frame_ns.front()); });
  if (!holds) return fmt::format("no frame is within it (frames are at 0 .. {:.6g} s)", last_s);
  if (fault.kind == FaultKind::drop && fault.holds_at(0)) return "the first frame cannot be missing";
  return {};
}

bool moves_before_camera(FaultKind kind) { return kind == FaultKind::hand || kind == FaultKind::person; }

std::int64_t nanoseconds(double time_s) { return std::llround(1e9 * time_s); }

}  // namespace

std::span<const FaultDescription> fault_kinds() { return kKinds; }

const FaultDescription& describe(FaultKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

bool SimulatedFault::holds_at(std::int64_t since_first_ns) const {
  return since_first_ns >= nanoseconds(begin_s) && since_first_ns < nanoseconds(end_s);
}

Result<SimulatedFault> parse_fault(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    return fail(ErrorCode::usage, fmt::format("fault {}: has no '='", text),
                fmt::format("faults are {}", kForm));
  }
  const auto kind = kind_of(text.substr(0, equals), text);
  if (!kind) return tl::unexpected(kind.error());
  std::vector<double> numbers;
  for (std::size_t begin = equals + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    const auto number = number_of(text.substr(begin, end - begin), text);
    if (!number) return tl::unexpected(number.error());
    numbers.push_back(*number);
    begin = end + 1;
  }
  const FaultDescription& description = describe(*kind);
  const std::size_t most = description.amount.empty() ? 2 : 3;
  if (numbers.size() < 2 || numbers.size() > most) {
    return fail(ErrorCode::usage,
                fmt::format("fault {}: has {} numbers ({} takes BEGIN:END{})", text, numbers.size(),
                            description.name, most == 3 ? " or BEGIN:END:AMOUNT" : ""),
                fmt::format("faults are {}", kForm));
  }
  return SimulatedFault{*kind, numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : description.usual};
}

std::string to_string(const SimulatedFault& fault) {
  const FaultDescription& kind = describe(fault.kind);
  const std::string times = fmt::format("{}={}:{}", kind.name, fault.begin_s, fault.end_s);
  return kind.amount.empty() ? times : fmt::format("{}:{}", times, fault.amount);
}

Result<void> check_faults(std::span<const SimulatedFault> faults, std::span<const std::int64_t> frame_ns) {
  check(frame_ns.size() >= 2, "a recording has at least two frames");
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (const std::string wrong = complaint(faults[i], frame_ns); !wrong.empty())
      return fail(ErrorCode::configuration, fmt::format("fault {}: {}", to_string(faults[i]), wrong));
    for (const SimulatedFault& other : faults.subspan(i + 1)) {
      if (other.begin_s >= faults[i].end_s || faults[i].begin_s >= other.end_s) continue;
      const bool same = other.kind == faults[i].kind;
      if (!same && !(moves_before_camera(other.kind) && moves_before_camera(faults[i].kind))) continue;
      return fail(ErrorCode::configuration,
                  fmt::format("faults {} and {} {} and overlap", to_string(faults[i]), to_string(other),
                              same ? "are of one kind" : "both move before the camera"),
                  "give one of them, or times that do not overlap");
    }
  }
  const std::vector<bool> dropped = dropped_frames(faults, frame_ns);
  const auto left = std::ranges::count(dropped, false);
  if (left >= 2) return {};
  return fail(ErrorCode::configuration, fmt::format("the faults leave {} frame (at least 2)", left),
              "drop fewer frames, or take a longer recording");
}

FrameFaults faults_at(std::span<const SimulatedFault> faults, std::int64_t since_first_ns) {
  FrameFaults now;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const SimulatedFault& fault = faults[i];
    if (!fault.holds_at(since_first_ns)) continue;
    now.black |= fault.kind == FaultKind::black;
    now.no_depth |= fault.kind == FaultKind::black || fault.kind == FaultKind::no_depth;
    now.no_texture |= fault.kind == FaultKind::no_texture;
    now.dropped |= fault.kind == FaultKind::drop;
    if (fault.kind == FaultKind::brightness) now.brightness = fault.amount;
    if (fault.kind == FaultKind::blur) now.exposure_s = fault.amount;
    if (fault.kind == FaultKind::hand) now.hand = i;
    if (fault.kind == FaultKind::person) now.person = i;
  }
  return now;
}

std::vector<bool> dropped_frames(std::span<const SimulatedFault> faults,
                                 std::span<const std::int64_t> frame_ns) {
  std::vector<bool> dropped;
  for (const std::int64_t t_ns : frame_ns)
    dropped.push_back(faults_at(faults, t_ns - frame_ns.front()).dropped);
  return dropped;
}

}  // namespace fusebench::simulator::faults
