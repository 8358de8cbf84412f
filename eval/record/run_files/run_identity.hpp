// What identifies a run: which recording, which configuration, which repetition and replicate.
#pragma once

#include <compare>
#include <cstddef>
#include <string>
#include <string_view>

#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/option_order.hpp"

namespace fusebench::run_files {

/// Tables, rankings, comparisons and reports group, label and pair runs by this alone.
struct RunIdentity {
  std::string recording;
  std::string fingerprint;        ///< of its content; empty: the run failed before it opened the recording
  std::string data = "recorded";  ///< "recorded", "simulated", kUnknownWord
  std::string imu = "none";       ///< used by the run: "none", "recorded", "synthetic IMU", kUnknownWord
  std::string truth;              ///< "none", "given", kPseudoTruthWord
  std::size_t first_frame = 0;    ///< of its window of the recording
  std::size_t frames = 0;         ///< of its window; 0: unknown
  std::size_t whole_frames = 0;   ///< of the whole recording where the window is a part of it; 0: unknown
  std::string variant;
  RunOptions options;          ///< edited options: those whose origin is_edit()
  bool wrote_options = false;  ///< the record has all options of this program
  std::string config_hash = {};
  std::size_t repetition = 1;
  std::size_t replicate = 0;
  std::string run = {};  ///< name of its folder

  [[nodiscard]] bool opened_recording() const { return !fingerprint.empty(); }
  auto operator<=>(const RunIdentity&) const = default;
};

/// Whether an option of that origin was edited by a user (a file, --set, a suite, a sweep), and is not a
/// default of the program or of the variant.
[[nodiscard]] bool is_edit(std::string_view origin);

[[nodiscard]] RunIdentity identity_of(const FoundRun& run);

/// The identity that all replicates of a run share: without replicate, folder and the origin of its options.
[[nodiscard]] RunIdentity without_replicate(RunIdentity identity);
/// The identity that all repetitions and replicates of a run share.
[[nodiscard]] RunIdentity without_repetition(RunIdentity identity);

}  // namespace fusebench::run_files
