#include "eval/run/run_specification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/config/config.hpp"
#include "core/config/variants.hpp"
#include "datasets/synthetic_imu/synthetic_imu.hpp"
#include "eval/record/run_files/run_identity.hpp"
#include "eval/run/preparation/preparation.hpp"

namespace fusebench::run {

namespace {

/// Whether a group of options belongs to a system, by its name; see system.method.
bool has_effect(std::string_view group, std::string_view system) {
  constexpr std::array<std::string_view, 10> kOfTheFilter = {
      "patches",     "photometric",    "geometric",      "alignment", "iekf",
      "color_drift", "relocalisation", "place_features", "segments",  "loops"};
  if (std::ranges::find(kOfTheFilter, group) != kOfTheFilter.end()) return system == "filter";
  return group == system || std::ranges::none_of(config::option_choices(config::SystemMethod{}),
                                                 [&](const auto& other) { return other.first == group; });
}

/// An option that somebody edited so that the configuration needs an IMU; nothing if the variant does.
std::optional<std::string> edit_that_needs_imu(const config::EffectiveConfig& config) {
  const bool filter = config.values().system.method == config::SystemMethod::filter;
  const auto uses = filter ? std::pair("terms.prior", "\"imu\"") : std::pair("elasticfusion.use_imu", "true");
  const std::pair method("system.method", filter ? "\"filter\"" : "\"elasticfusion\"");
  for (const auto& [key, value] : {uses, method}) {
    const std::string origin = config.origin(key);
    if (run_files::is_edit(origin)) return fmt::format("{}: {} = {}", origin, key, value);
  }
  return std::nullopt;
}

/// What is needed and not there; without a truth nothing can be made from it.
tl::unexpected<Error> no_imu(const recording::Recording& recording, const RunSpec& spec) {
  const bool has_truth = !recording.ground_truth.empty();
  const std::string_view no_truth = "there is no ground truth to make an IMU from";
  if (spec.program)
    return fail(ErrorCode::usage,
                fmt::format("{}: imu = \"recorded\", and recording '{}' has no inertial samples",
                            spec.program->file.string(), recording.name),
                has_truth ? "--imu synthetic makes samples from the ground truth; every table labels them"
                          : fmt::format("imu = \"none\" runs it without; {}", no_truth));
  if (const auto edit = edit_that_needs_imu(spec.config)) {
    return fail(ErrorCode::usage,
                fmt::format("{} needs an IMU, and recording '{}' has none", *edit, recording.name),
                fmt::format("take that option away (it edits variant '{}'){}", spec.variant,
                            has_truth ? ", or make an IMU from the ground truth with --imu synthetic"
                                      : fmt::format("; {}", no_truth)));
  }
  return fail(
      ErrorCode::usage,
      fmt::format("variant '{}' needs an IMU, and recording '{}' has none", spec.variant, recording.name),
      has_truth ? "--imu synthetic (or auto) makes an IMU from the ground truth, and every table labels it; "
                  "--variant no-imu needs none"
                : fmt::format("--variant no-imu and dm-no-imu do without; {}", no_truth));
}

Result<void> provide_imu(recording::Recording& recording, const RunSpec& spec) {
  if (!wants_imu(spec)) {
    recording.imu.clear();
    recording.imu_source = recording::ImuSource::none;
    recording.imu_note.clear();
    return {};
  }
  const bool recorded = recording.imu_source != recording::ImuSource::none;
  if (spec.imu == ImuChoice::synthetic || (spec.imu == ImuChoice::automatic && !recorded))
    return synthetic_imu::add_synthetic_imu(recording);
  if (recorded) return {};
  return no_imu(recording, spec);
}

}  // namespace

std::optional<std::string> options_without_effect(const config::EffectiveConfig& config) {
  std::string_view system;
  for (const auto& [name, method] : config::option_choices(config::SystemMethod{})) {
    if (method == config.values().system.method) system = name;
  }
  std::string keys;
  for (const auto& [key, origin] : config.origins) {
    if (!run_files::is_edit(origin) || has_effect(key.substr(0, key.find('.')), system)) continue;
    keys += (keys.empty() ? "" : ", ") + key;
  }
  if (keys.empty()) return std::nullopt;
  return fmt::format("without effect: {} (system.method = \"{}\" has no such options)", keys, system);
}

bool runs_filter(const RunSpec& spec) {
  return !spec.program && spec.config.values().system.method == config::SystemMethod::filter;
}

int seed_of(const RunSpec& spec) { return spec.repetition + spec.replicate; }

bool is_prepared(const RunSpec& spec, const recording::Recording& recording) {
  return spec.prepare && !spec.program && preparation::can_be_prepared(recording);
}

bool wants_imu(const RunSpec& spec) {
  return spec.program ? spec.program->imu != "none" : config::needs_imu(spec.config.values());
}

std::string_view to_string(KeptFiles kept) { return kept == KeptFiles::all ? "all" : "small"; }

Result<FrameWindow> parse_window(const std::string& text) {
  if (text.starts_with(':')) return parse_window("0" + text);
  FrameWindow window;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, window.begin);
  const bool colon = first.ec == std::errc{} && first.ptr != end && *first.ptr == ':';
  const bool open = colon && first.ptr + 1 == end;
  const auto second = colon && !open ? std::from_chars(first.ptr + 1, end, window.end.emplace()) : first;
  if (!colon || second.ec != std::errc{} || (!open && second.ptr != end) ||
      (window.end && window.begin >= *window.end)) {
    return fail(ErrorCode::usage, fmt::format("frames {} (allowed: A:B with 0 <= A < B, A: or :B)", text),
                "A:B takes frames A to B-1, A: all from A on, :B the first B");
  }
  return window;
}

std::string to_string(const FrameWindow& window) {
  return fmt::format("{}:{}", window.begin, window.end ? fmt::format("{}", *window.end) : "");
}

Result<void> select_window(recording::Recording& recording, const FrameWindow& window) {
  const std::size_t count = recording.frames.size();
  if (!window.end && window.begin >= count && count > 0) {
    return fail(ErrorCode::usage,
                fmt::format("frames {} begins behind the end: '{}' has {} frames, 0 to {}", to_string(window),
                            recording.name, count, count - 1),
                fmt::format("A: takes all from A on (allowed: 0 to {})", count - 1));
  }
  return recording::select_frames(recording, window.begin, window.end.value_or(recording.frames.size()));
}

Result<recording::Recording> open_window(const std::filesystem::path& recording,
                                         const datasets::OpenOptions& options,
                                         const std::optional<FrameWindow>& window) {
  auto opened = datasets::open_recording(recording, options);
  if (!opened || !window) return opened;
  if (auto cut = select_window(*opened, *window); !cut) return tl::unexpected(cut.error());
  return opened;
}

Result<recording::Recording> view_for_run(recording::Recording whole, const RunSpec& spec) {
  if (spec.frames) {
    if (auto cut = select_window(whole, *spec.frames); !cut) return tl::unexpected(cut.error());
  }
  if (whole.frames.empty()) {
    return fail(ErrorCode::data_corrupt, fmt::format("recording '{}' has no frames", whole.name));
  }
  if (auto provided = provide_imu(whole, spec); !provided) return tl::unexpected(provided.error());
  return whole;
}

Result<recording::Recording> open_for_run(const RunSpec& spec) {
  auto whole = datasets::open_recording(spec.recording, spec.open);
  if (!whole) return whole;
  return view_for_run(std::move(*whole), spec);
}

}  // namespace fusebench::run
