// Recordings that several runs share.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/error.hpp"
#include "datasets/recording.hpp"
#include "eval/run.hpp"

namespace fusebench {

/// The recording that was asked for last, in each form in which runs see it (window, IMU): jobs over one
/// recording stand together, and reading its lists and fingerprinting its images once is enough.
class OpenedRecordings {
 public:
  /// As open_for_run(). Valid until another recording is asked for.
  [[nodiscard]] const Result<Recording>& of(const RunSpec& spec);

 private:
  std::filesystem::path recording_;
  std::map<std::string, Result<Recording>> opened_;
};

}  // namespace fusebench
