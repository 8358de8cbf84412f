// Where the repository is that the tests were compiled from.
#pragma once

#include <filesystem>

namespace fusebench::testing {

[[nodiscard]] inline std::filesystem::path repository_root() {
  return std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
}

}  // namespace fusebench::testing
