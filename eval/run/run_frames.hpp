// The frames of a run through its system, and what they leave behind for its files and metrics.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/base/error.hpp"
#include "core/base/replay.hpp"
#include "core/health/frame_report.hpp"
#include "core/io/staged_folder.hpp"
#include "core/systems/system.hpp"
#include "eval/profile/run_profile.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_placement.hpp"
#include "eval/run_files/filter_tables.hpp"
#include "eval/run_files/frame_table.hpp"
#include "eval/run_files/patch_table.hpp"

namespace fusebench::run {

/// What a system of the run replays frames by (base/replay.hpp).
class FrameReplay {
 public:
  /// The references must outlive it.
  FrameReplay(const PreparedRun& run, const RunControl& control) : run_(run), control_(control) {}

  /// So many frames were given to the system.
  void set_seen(std::size_t frames) { seen_ = frames; }

  /// The frames that were seen, in order. Errors: run_failed (a stop), those of the recording and the
  /// visitor.
  [[nodiscard]] Result<void> visit(const FrameVisitor& visitor) const;

 private:
  const PreparedRun& run_;
  const RunControl& control_;
  std::size_t seen_ = 0;
};

/// What the frames left behind; grows frame by frame.
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
  profile::RunProfile profile;  ///< stays without frames unless it is asked for

  void end(record::RunStatus how, std::string why);
};

/// Processes all frames; the replay, which the system was made with, follows. intensity.bin goes into
/// `folder` if it is kept. Errors: io, run_failed (a stop), and bad data if it is not recorded; whatever else
/// goes wrong ends the run and is in the progress.
[[nodiscard]] Result<RunProgress> process_frames(const PreparedRun& run, systems::System& system,
                                                 FrameReplay& replay, const io::StagedFolder& folder,
                                                 const RunControl& control);

}  // namespace fusebench::run
