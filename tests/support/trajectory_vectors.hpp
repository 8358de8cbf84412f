// Numbers that the tools of others computed: a part of them in the repository (tests/golden/trajectories),
// all of them beside the recordings. Where those are not, tests on all of them say so.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/expect_close.hpp"
#include "tests/support/repository.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

enum class VectorSet { golden, large };

/// What gunzip makes of a file; empty if it cannot be read.
[[nodiscard]] inline std::string unzipped(const std::filesystem::path& file) {
  std::string text;
  const gzFile opened = gzopen(file.c_str(), "rb");
  if (opened == nullptr) return text;
  std::array<char, 65536> buffer;
  for (int count = 0; (count = gzread(opened, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  gzclose(opened);
  return text;
}

/// A fixture that runs once over either set.
class TrajectoryVectors : public ::testing::TestWithParam<VectorSet> {
 protected:
  void SetUp() override {
    if (GetParam() == VectorSet::golden) {
      folder_ = repository_root() / "tests" / "golden" / "trajectories";
      return;
    }
    const char* const data = std::getenv("FUSEBENCH_DATA");
    if (data != nullptr) folder_ = std::filesystem::path(data) / ".." / "vectors" / "trajectory";
    if (data == nullptr || !std::filesystem::exists(folder_ / "tum_expected.json"))
      GTEST_SKIP() << "FUSEBENCH_DATA is not set, or has no ../vectors/trajectory beside it";
  }

  [[nodiscard]] nlohmann::json cases(const char* file) const {
    return nlohmann::json::parse(std::ifstream(folder_ / file)).at("cases");
  }

  /// An input, unpacked.
  [[nodiscard]] std::filesystem::path input(const std::string& name) const {
    const std::filesystem::path plain = folder_ / "inputs" / name;
    if (std::filesystem::exists(plain)) return plain;
    const std::filesystem::path unpacked = temporary_.path() / name;
    return std::filesystem::exists(unpacked) ? unpacked
                                             : temporary_.write(name, unzipped(plain.string() + ".gz"));
  }

  /// How many cases have to be there: none is left out in silence.
  [[nodiscard]] static int count(int golden, int large) {
    return GetParam() == VectorSet::golden ? golden : large;
  }

 private:
  std::filesystem::path folder_;
  const TemporaryFolder temporary_;
};

[[nodiscard]] inline std::string name_of(const ::testing::TestParamInfo<VectorSet>& set) {
  return set.param == VectorSet::golden ? "golden" : "large";
}

}  // namespace fusebench::testing

#define OVER_BOTH_VECTOR_SETS(fixture)                                                               \
  INSTANTIATE_TEST_SUITE_P(Of, fixture,                                                              \
                           ::testing::Values(testing::VectorSet::golden, testing::VectorSet::large), \
                           testing::name_of)
