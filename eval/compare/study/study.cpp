#include "eval/compare/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "eval/record/registry/run_numbers.hpp"
#include "eval/record/run_files/record_files.hpp"

namespace fusebench::study {

namespace {

/// False for a run of a suite with keep = "small", and for a system that has no patches.
bool kept_intensities(const StudyRun& run) {
  std::error_code ignored;
  return std::filesystem::exists(run.folder / "intensity.bin", ignored);
}

/// The frames of the pair, with the motion that the reference saw.
Result<std::vector<SharedFrame>> compared(const StudyRun& reference, const StudyRun& run) {
  for (const StudyRun* side : {&reference, &run}) {
    if (auto checked = run_files::check_file(side->folder, side->record, "intensity.bin"); !checked)
      return tl::unexpected(checked.error());
  }
  auto frames = shared_frames(reference.folder / "intensity.bin", run.folder / "intensity.bin");
  if (!frames) return frames;
  const auto motion = read_patch_motion(reference.folder / "frames.csv");
  if (!motion) return tl::unexpected(motion.error());
  for (SharedFrame& frame : *frames) {
    const auto found = motion->find(frame.timestamp_ns);
    if (found != motion->end()) frame.motion_px = found->second;
  }
  return frames;
}

}  // namespace

Study gather_study(std::vector<StudyRun> runs, std::vector<std::string> variants) {
  check(!variants.empty(), "a suite names a variant");
  Study study{std::move(variants), std::move(runs), {}};
  bool without_pixels = false;
  for (StudyRun& run : study.runs) {
    if (run.variant == study.reference() || run.record.status != record::RunStatus::ok) continue;
    const StudyRun* reference = sibling(study, run, study.reference());
    if (reference == nullptr || reference->record.status != record::RunStatus::ok) continue;
    if (!kept_intensities(run) || !kept_intensities(*reference)) {
      without_pixels = true;
      continue;
    }
    auto frames = compared(*reference, run);
    if (frames) {
      run.shared = std::move(*frames);
    } else {
      study.notes.push_back(fmt::format("{}, {}: no AIE on common pixels: {}", run.recording, run.variant,
                                        frames.error().message));
    }
  }
  if (without_pixels)
    study.notes.emplace_back("no AIE on common pixels of runs that kept no intensity.bin (keep = \"small\")");
  return study;
}

const StudyRun* sibling(const Study& study, const StudyRun& run, std::string_view variant) {
  const auto found = std::find_if(study.runs.begin(), study.runs.end(), [&](const StudyRun& other) {
    return other.variant == variant && other.recording == run.recording;
  });
  return found == study.runs.end() ? nullptr : &*found;
}

std::optional<double> value_of(const Study& study, const StudyRun& run, const registry::RunMetric& metric,
                               std::string_view partner) {
  if (run.record.status != record::RunStatus::ok && !metric.of_every_run) return std::nullopt;
  if (!metric.takes_several_runs()) return registry::number_of(run.record, metric).value;
  const bool is_reference = run.variant == study.reference();
  const StudyRun* pair =
      is_reference ? sibling(study, run, partner.empty() ? study.partner() : partner) : &run;
  if (pair == nullptr) return std::nullopt;
  const SharedMeans means = shared_means(pair->shared);
  if (means.frames == 0) return std::nullopt;
  return is_reference ? means.reference_grey : means.variant_grey;
}

}  // namespace fusebench::study
