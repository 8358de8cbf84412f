// Stamps: units, order, gaps, coverage, association.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"
#include "datasets/recording/reader_words.hpp"

namespace fusebench::inspection {

namespace {

// An interval of this many medians misses at least one entry; stamps jitter by less.
constexpr double kGapMedians = 1.75;
// From here on a pause of the images is reported on its own: a tracker has to bridge it.
constexpr double kLongPause_s = 0.1;

struct RateRange {
  double min_hz;
  double max_hz;
};
constexpr RateRange kCameraRates{1, 400};
constexpr RateRange kTruthRates{1, 2000};
constexpr RateRange kImuRates{20, 8000};

/// What the stamps must be multiplied with to have a plausible rate, if they have none as they are.
std::optional<double> unit_factor(const StampMeasurement& stamps, RateRange range) {
  if (stamps.count < 3 || stamps.median_interval_s <= 0) return std::nullopt;
  const auto plausible = [&](double factor) {
    const double rate_hz = 1 / (stamps.median_interval_s * factor);
    return rate_hz >= range.min_hz && rate_hz <= range.max_hz;
  };
  if (plausible(1)) return std::nullopt;
  for (const double factor : {1e-3, 1e-6, 1e-9, 1e3, 1e6, 1e9}) {
    if (plausible(factor)) return factor;
  }
  return std::nullopt;
}

std::string_view unit_name(double factor) {
  if (factor < 1e-8) return "nanoseconds read as seconds";
  if (factor < 1e-5) return "microseconds read as seconds, or nanoseconds as milliseconds";
  if (factor < 1) return "milliseconds read as seconds, or microseconds as milliseconds";
  if (factor < 1e5) return "seconds read as milliseconds, or milliseconds as microseconds";
  return "seconds read as microseconds";
}

/// Whether the unit is wrong; reported.
bool report_unit(std::string_view code, std::string_view list, const StampMeasurement& stamps,
                 RateRange range, Inspection& out) {
  const auto factor = unit_factor(stamps, range);
  if (!factor) return false;
  out.add(code, Severity::error,
          fmt::format("the median interval between {} is {:.6g} s ({:.4g} Hz): these look like {}", list,
                      stamps.median_interval_s, stamps.rate_hz, unit_name(*factor)),
          fmt::format("multiply the stamps by {:g}, or correct the unit in the program that wrote them",
                      *factor));
  return true;
}

template <class Entries, class Member>
std::vector<std::int64_t> stamps_of(const Entries& entries, Member member) {
  std::vector<std::int64_t> stamps;
  stamps.reserve(entries.size());
  for (const auto& entry : entries) stamps.push_back(entry.*member);
  return stamps;
}

/// Index of the stamp at which the largest interval begins.
std::size_t largest_interval(std::span<const std::int64_t> stamps_ns) {
  std::size_t largest = 0;
  for (std::size_t i = 0; i + 1 < stamps_ns.size(); ++i) {
    if (stamps_ns[i + 1] - stamps_ns[i] > stamps_ns[largest + 1] - stamps_ns[largest]) largest = i;
  }
  return largest;
}

/// The first entry whose stamp is not later than the one before it.
std::size_t first_disorder(std::span<const std::int64_t> stamps_ns, bool equal) {
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    if (equal ? stamps_ns[i] == stamps_ns[i - 1] : stamps_ns[i] < stamps_ns[i - 1]) return i;
  }
  return 0;
}

void report_frame_gaps(std::span<const std::int64_t> stamps_ns, Inspection& out) {
  const StampMeasurement& stamps = out.color_stamps;
  if (stamps.gaps == 0) return;
  if (stamps.max_interval_s >= std::max(kLongPause_s, 2.5 * stamps.median_interval_s)) {
    const std::size_t frame = largest_interval(stamps_ns);
    out.add("frames-gap", Severity::warning,
            fmt::format(
                "the images pause {} times ({} frames missing); the longest pause is {:.3f} s after frame {} "
                "at {:.2f} s",
                stamps.gaps, stamps.missing, stamps.max_interval_s, frame,
                seconds_between(stamps_ns.front(), stamps_ns[frame])),
            "expect a tracker to be lost there; use --frames A:B to keep to one side of it");
    return;
  }
  const double share =
      static_cast<double>(stamps.missing) / static_cast<double>(stamps.count + stamps.missing);
  out.add("frames-dropped", share > 0.05 ? Severity::warning : Severity::note,
          fmt::format("single frames are missing: {} ({:.1f} % of {:.1f} Hz)", stamps.missing, 100 * share,
                      stamps.rate_hz));
}

void check_association(const recording::Recording& recording, Inspection& out) {
  AssociationMeasurement& association = out.association;
  std::vector<double> differences_s;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const recording::FrameEntry& frame = recording.frames[i];
    differences_s.push_back(std::abs(seconds_between(frame.timestamp_ns, frame.depth_timestamp_ns)));
    association.max_s = std::max(association.max_s, differences_s.back());
    if (i > 0 && frame.depth_timestamp_ns == recording.frames[i - 1].depth_timestamp_ns) ++association.reused;
  }
  association.median_s = measures::median(differences_s);
  if (association.reused > 0) {
    out.add("depth-reused", Severity::warning,
            fmt::format("{} frames have the depth image of the frame before", association.reused),
            "drop the frames without a depth image of their own from the list");
  }
  // Half a period is what two free-running sensors can be apart.
  if (association.median_s > 0.6 * std::max(out.color_stamps.median_interval_s, 0.02)) {
    out.add("association-loose", Severity::warning,
            fmt::format("colour and depth of a frame are {:.1f} ms apart in the median, {:.1f} ms at most",
                        1e3 * association.median_s, 1e3 * association.max_s),
            "check that both lists are of one clock");
  }
}

}  // namespace

StampMeasurement measure_stamps(std::span<const std::int64_t> stamps_ns) {
  StampMeasurement result;
  result.count = stamps_ns.size();
  if (stamps_ns.size() < 2) return result;
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    intervals_s.push_back(seconds_between(stamps_ns[i - 1], stamps_ns[i]));
    if (stamps_ns[i] == stamps_ns[i - 1]) ++result.duplicates;
    if (stamps_ns[i] < stamps_ns[i - 1]) ++result.backwards;
  }
  const auto [min, max] = std::ranges::minmax(intervals_s);
  result.duration_s = seconds_between(stamps_ns.front(), stamps_ns.back());
  result.median_interval_s = measures::median(intervals_s);
  result.min_interval_s = min;
  result.max_interval_s = max;
  if (result.median_interval_s <= 0) return result;
  double squares = 0;
  std::size_t regular = 0;
  for (const double interval_s : intervals_s) {
    const double medians = interval_s / result.median_interval_s;
    if (medians >= kGapMedians) {
      ++result.gaps;
      result.missing += static_cast<std::size_t>(std::llround(medians)) - 1;
    } else {
      squares += (interval_s - result.median_interval_s) * (interval_s - result.median_interval_s);
      ++regular;
    }
  }
  if (result.duration_s > 0 && result.duplicates + result.backwards == 0)
    result.rate_hz = static_cast<double>(result.count - 1 + result.missing) / result.duration_s;
  result.jitter_rms_s = regular == 0 ? 0 : std::sqrt(squares / static_cast<double>(regular));
  return result;
}

std::int64_t truth_gap_ns(const recording::Recording& recording) {
  const auto stamps = stamps_of(recording.ground_truth, &StampedPose::timestamp_ns);
  return std::llround(1e9 * std::max(0.1, 2.5 * measure_stamps(stamps).median_interval_s));
}

bool times_are_plausible(const Inspection& out) {
  return !out.has("frames-time-unit") && !out.has("truth-time-unit") && !out.has("imu-time-unit");
}

void check_frame_stamps(const recording::Recording& recording, Inspection& out) {
  const auto color_ns = stamps_of(recording.frames, &recording::FrameEntry::timestamp_ns);
  out.color_stamps = measure_stamps(color_ns);
  out.depth_stamps = measure_stamps(stamps_of(recording.frames, &recording::FrameEntry::depth_timestamp_ns));
  const StampMeasurement& stamps = out.color_stamps;
  if (stamps.duplicates > 0) {
    const std::size_t frame = first_disorder(color_ns, true);
    out.add("frames-duplicate-stamp", Severity::error,
            fmt::format("{} frames have the stamp of the frame before; the first is frame {} at {:.3f} s",
                        stamps.duplicates, frame, seconds_between(color_ns.front(), color_ns[frame])),
            "remove the doubled rows from the list of images");
  }
  if (stamps.backwards > 0) {
    out.add("frames-out-of-order", Severity::error,
            fmt::format("{} frames are earlier than the frame before; the first is frame {}",
                        stamps.backwards, first_disorder(color_ns, false)),
            "sort the list of images by time");
  }
  const bool wrong_unit = report_unit("frames-time-unit", "frames", stamps, kCameraRates, out);
  if (!wrong_unit && stamps.backwards == 0) report_frame_gaps(color_ns, out);
  check_association(recording, out);
}

void check_truth_stamps(const recording::Recording& recording, Inspection& out) {
  const Trajectory& truth = recording.ground_truth;
  if (truth.empty()) {
    out.add(
        "truth-none", Severity::note,
        "there is no ground truth: trajectory errors cannot be computed, and the calibration is tested less");
    return;
  }
  TruthMeasurement& measured = out.truth.emplace();
  measured.stamps = measure_stamps(stamps_of(truth, &StampedPose::timestamp_ns));
  if (report_unit("truth-time-unit", "poses of the ground truth", measured.stamps, kTruthRates, out)) return;
  if (measured.stamps.backwards + measured.stamps.duplicates > 0) {
    out.add("truth-out-of-order", Severity::error,
            fmt::format("{} poses of the ground truth are not later than the pose before",
                        measured.stamps.backwards + measured.stamps.duplicates),
            "sort the poses by time, and keep one for each stamp");
    return;
  }
  const std::int64_t gap_ns = truth_gap_ns(recording);
  std::size_t covered = 0;
  for (const recording::FrameEntry& frame : recording.frames) {
    if (trajectory::interpolate_pose(truth, frame.capture_ns, gap_ns)) ++covered;
  }
  // The first or last image may be taken a moment outside of what has truth.
  measured.coverage =
      static_cast<double>(covered) / static_cast<double>(std::max<std::size_t>(1, recording.frames.size()));
  if (covered + 2 < recording.frames.size() || covered == 0) {
    out.add(
        "truth-coverage", covered == 0 ? Severity::error : Severity::warning,
        fmt::format("{} of {} {} within {:.2f} s", recording.frames.size() - covered, recording.frames.size(),
                    recording::kUncoveredByTruth, 1e-9 * static_cast<double>(gap_ns)),
        covered == 0 ? "check the clock and the unit of the ground truth" : "metrics leave these frames out");
  }
  if (measured.stamps.max_interval_s > 1e-9 * static_cast<double>(gap_ns)) {
    out.add("truth-gap", Severity::note,
            fmt::format("the ground truth pauses for up to {:.2f} s (median interval {:.1f} ms)",
                        measured.stamps.max_interval_s, 1e3 * measured.stamps.median_interval_s));
  }
}

void check_imu_stamps(const recording::Recording& recording, Inspection& out) {
  const auto& samples = recording.imu;
  if (samples.empty()) {
    out.add("imu-none", Severity::note,
            recording.ground_truth.empty()
                ? "there is no IMU: variants with an inertial prior cannot run"
                : "there is no IMU: variants with an inertial prior need --imu synthetic");
    return;
  }
  const auto stamps_ns = stamps_of(samples, &ImuSample::timestamp_ns);
  ImuMeasurement& measured = out.imu.emplace();
  measured.stamps = measure_stamps(stamps_ns);
  const StampMeasurement& stamps = measured.stamps;
  if (report_unit("imu-time-unit", "samples of the IMU", stamps, kImuRates, out)) return;
  if (stamps.duplicates > 0) {
    out.add("imu-duplicate-stamp", Severity::error,
            fmt::format("{} samples have the stamp of the sample before; the first is sample {}",
                        stamps.duplicates, first_disorder(stamps_ns, true)),
            "remove the doubled rows");
  }
  if (stamps.backwards > 0) {
    out.add("imu-out-of-order", Severity::error,
            fmt::format("{} samples are earlier than the sample before; the first is sample {}",
                        stamps.backwards, first_disorder(stamps_ns, false)),
            "sort the samples by time");
    return;
  }
  if (stamps.max_interval_s > std::max(0.02, 3.5 * stamps.median_interval_s)) {
    const std::size_t sample = largest_interval(stamps_ns);
    out.add("imu-gap", stamps.max_interval_s > 0.5 ? Severity::error : Severity::warning,
            fmt::format("the IMU pauses {} times ({} samples missing); the longest pause is {:.3f} s after "
                        "sample {}, {:.2f} s "
                        "after the first frame",
                        stamps.gaps, stamps.missing, stamps.max_interval_s, sample,
                        seconds_between(recording.frames.front().timestamp_ns, stamps_ns[sample])),
            "an inertial prior has no information on the motion within the pause; use --frames A:B to "
            "exclude it");
  }
  if (stamps.rate_hz > 0 && stamps.rate_hz < 90) {
    out.add("imu-rate-low", Severity::warning,
            fmt::format("the IMU has {:.1f} Hz: fast motion between samples is lost", stamps.rate_hz));
  }
  const auto covered = std::ranges::count_if(recording.frames, [&](const recording::FrameEntry& frame) {
    return frame.capture_ns >= stamps_ns.front() && frame.capture_ns <= stamps_ns.back();
  });
  measured.coverage = static_cast<double>(covered) / static_cast<double>(recording.frames.size());
  if (static_cast<std::size_t>(covered) + 2 < recording.frames.size()) {
    out.add("imu-coverage", covered == 0 ? Severity::error : Severity::warning,
            fmt::format(
                "{} of {} frames are outside of the IMU's time ({:.3f} s to {:.3f} s after the first frame)",
                recording.frames.size() - static_cast<std::size_t>(covered), recording.frames.size(),
                seconds_between(recording.frames.front().capture_ns, stamps_ns.front()),
                seconds_between(recording.frames.front().capture_ns, stamps_ns.back())),
            covered == 0 ? "check the clock and the unit of both lists"
                         : "use --frames A:B to keep to what is covered");
  }
}

}  // namespace fusebench::inspection
