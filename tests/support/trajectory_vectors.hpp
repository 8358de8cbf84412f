// Numbers that the tools of others computed, beside the recordings. Where those are not, tests say so.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/support/expect_close.hpp"

namespace fusebench::testing {

/// The folder of the vectors, or nothing if FUSEBENCH_DATA is not set or has none beside it.
[[nodiscard]] inline std::optional<std::filesystem::path> trajectory_vectors() {
  const char* const data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) return std::nullopt;
  const auto folder = std::filesystem::path(data) / ".." / "vectors" / "trajectory";
  if (!std::filesystem::exists(folder / "tum_expected.json")) return std::nullopt;
  return folder;
}

[[nodiscard]] inline nlohmann::json vector_cases(const std::filesystem::path& folder, const char* file) {
  return nlohmann::json::parse(std::ifstream(folder / file)).at("cases");
}

}  // namespace fusebench::testing

#define SKIP_WITHOUT_VECTORS(folder) \
  if (!folder) GTEST_SKIP() << "FUSEBENCH_DATA is not set, or has no ../vectors/trajectory beside it"
