// Recordings that several runs share.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/base/error.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/run/run.hpp"

namespace fusebench::engine {

/// The recording that was asked for last, in each form in which runs see it (window, IMU): jobs over one
/// recording stand together, and reading its lists and fingerprinting its images once is enough.
class OpenedRecordings {
 public:
  /// As open_for_run(). Valid until another recording is asked for.
  [[nodiscard]] const Result<recording::Recording>& of(const run::RunSpec& spec);

 private:
  std::filesystem::path recording_;
  std::map<std::string, Result<recording::Recording>> opened_;
};

}  // namespace fusebench::engine
