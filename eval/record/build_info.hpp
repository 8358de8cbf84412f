// What this binary was built from and how; filled in by the build.
#pragma once

#include <string_view>

namespace fusebench::record {

struct BuildInfo {
  std::string_view version;  ///< "0.1.0"
  std::string_view git;  ///< `git describe --always --dirty` at build time; "unknown" outside a repository
  std::string_view compiler;  ///< "GNU 12.2.0"
  std::string_view flags;
  /// Of all that numbers depend on: sources of the estimator, the readers and the metrics, compiler and
  /// flags. 12 hex digits; documents and the command line do not change it.
  std::string_view estimator;
};

[[nodiscard]] const BuildInfo& build_info();

}  // namespace fusebench::record
