// Recordings that several runs share; each is first opened in a process that may hang or take too much.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/run/run.hpp"
#include "eval/suites/run_selection.hpp"

namespace fusebench::engine {

/// Calls `open` in a child, within the limits of a run; where they set none for memory, within what the
/// machine has. Reading counts as progress, so that a large recording is not taken for one that hangs, as on
/// a network folder whose server is gone. This process opens the recording once more then, from the system's
/// cache of files. Errors: those of `open`; run_failed if the child hung, crashed or took too much, or was
/// stopped; io if there can be no child.
[[nodiscard]] Result<void> try_opening(const std::function<Result<void>()>& open,
                                       const suites::RunLimits& limits, const std::atomic<bool>* stop);

/// The recording that was requested last, as it is and in each form in which runs over the window that was
/// asked for last see it: jobs over one recording stand together, those over one window as well, and reading
/// its lists and fingerprinting its images once is enough.
class OpenedRecordings {
 public:
  /// Each recording is first tried in a child within these limits (try_opening()).
  explicit OpenedRecordings(const suites::RunLimits& limits, const std::atomic<bool>* stop = nullptr)
      : limits_(limits), stop_(stop) {}

  /// As open_for_run(), with the errors of try_opening() as well. Valid until the next call.
  [[nodiscard]] const Result<recording::Recording>& of(const run::RunSpec& spec);

 private:
  void open(const run::RunSpec& spec);

  suites::RunLimits limits_;
  const std::atomic<bool>* stop_;
  std::filesystem::path recording_;
  std::optional<Result<recording::Recording>> whole_;
  std::string window_;
  std::map<std::string, Result<recording::Recording>> views_;  ///< by the IMU that is wanted
};

}  // namespace fusebench::engine
