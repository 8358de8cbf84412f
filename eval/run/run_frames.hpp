// Processes the frames of a run and collects their results for files and metrics.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/base/error.hpp"
#include "core/base/io/staged_folder.hpp"
#include "core/base/replay.hpp"
#include "core/estimator/health/frame_report.hpp"
#include "core/system/system.hpp"
#include "eval/record/profile/run_profile.hpp"
#include "eval/record/record.hpp"
#include "eval/record/run_files/filter_tables.hpp"
#include "eval/record/run_files/frame_table.hpp"
#include "eval/record/run_files/patch_table.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_placement.hpp"

namespace fusebench::run {

/// The replay interface of a run (base/replay.hpp).
class FrameReplay {
 public:
  /// The references must outlive it.
  FrameReplay(const PreparedRun& run, const RunControl& control) : run_(run), control_(control) {}

  /// Sets the number of frames that the system has processed.
  void set_seen(std::size_t frames) { seen_ = frames; }

  /// Visits the processed frames in order. Errors: run_failed (a stop), those of the recording and the
  /// visitor.
  [[nodiscard]] Result<void> visit(const FrameVisitor& visitor) const;

 private:
  const PreparedRun& run_;
  const RunControl& control_;
  std::size_t seen_ = 0;
};

/// Results of the frames so far.
struct RunProgress {
  record::RunStatus status = record::RunStatus::ok;
  std::string reason;
  record::RecordedFrames frames;
  std::size_t lost_in_a_row = 0;
  RunOutput output;
  run_files::FastestFrames fastest;
  std::string frame_table = run_files::frame_table_header();
  std::string state_table = run_files::state_table_header();
  std::string log;
  double decode_ms = 0;
  std::array<double, health::kStageNames.size()> stage_ms{};
  profile::RunProfile profile;  ///< empty unless requested

  void end(record::RunStatus how, std::string why);
};

/// Processes all frames; the replay, which the system was made with, follows. intensity.bin goes into
/// `folder` if it is kept. Errors: io, run_failed (a stop), and bad data if it is not recorded; any other
/// failure ends the run and is stored in the progress.
[[nodiscard]] Result<RunProgress> process_frames(const PreparedRun& run, system::System& system,
                                                 FrameReplay& replay, const io::StagedFolder& folder,
                                                 const RunControl& control);

}  // namespace fusebench::run
