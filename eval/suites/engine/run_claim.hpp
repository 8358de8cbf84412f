// Who works on a run: two engines on one folder share the work instead of doing it twice.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::engine {

/// The folder of what engines keep among the runs of `out`: no table looks into it, see is_engine_folder().
[[nodiscard]] std::filesystem::path engine_folder(const std::filesystem::path& out);

/// The name of the claim on a run: its identity (32 hex digits) and its repetition.
[[nodiscard]] std::string claim_name(const std::string& run_id, int repetition);

/// A claim on one run, as a lock that the system lets go of when its last holder ends, however it ends. It is
/// inherited by processes that are forked while it is held.
class RunClaim {
 public:
  /// Nothing if another engine holds it. Where the file system has no locks, everybody gets every claim: work
  /// may then be done twice, which changes no result. Error io if the folder cannot be written.
  [[nodiscard]] static Result<std::optional<RunClaim>> take(const std::filesystem::path& out,
                                                            const std::string& name);

  RunClaim(RunClaim&& other) noexcept;
  RunClaim& operator=(RunClaim&&) = delete;
  ~RunClaim();  ///< lets go and removes the file

 private:
  RunClaim(std::filesystem::path file, int descriptor) : file_(std::move(file)), descriptor_(descriptor) {}

  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Removes the files of claims that nobody holds: engines that were killed left them. Returns them, or, if it
/// shall only look, those that there are to remove.
std::vector<std::filesystem::path> remove_free_claims(const std::filesystem::path& out,
                                                      bool only_look = false);

}  // namespace fusebench::engine
