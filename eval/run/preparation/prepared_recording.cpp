#include "eval/run/preparation/prepared_recording.hpp"

#include <fmt/format.h>

#include <system_error>
#include <tuple>
#include <utility>

#include "core/base/io/fingerprint.hpp"
#include "core/base/io/staged_file.hpp"
#include "eval/record/build_info.hpp"
#include "eval/run/preparation/preparation.hpp"

namespace fusebench::preparation {

namespace {

constexpr std::size_t kKeyDigits = 16;

/// Where the results cannot be written, the run will say so.
void keep(const std::filesystem::path& file, const calibration::RigCalibration& rig) {
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (!failed) std::ignore = io::write_file_atomically(file, calibration::to_toml(rig));
}

}  // namespace

std::filesystem::path preparation_file(const std::filesystem::path& out,
                                       const recording::Recording& recording) {
  io::Fingerprint key;
  key.add(recording.fingerprint);
  key.add(record::build_info().estimator);
  return out / "prepared" / fmt::format("{}-{}.toml", recording.name, key.hex().substr(0, kKeyDigits));
}

bool is_kept(const std::filesystem::path& out, const recording::Recording& recording) {
  std::error_code ignored;
  return std::filesystem::exists(preparation_file(out, recording), ignored);
}

Result<recording::Recording> prepared_recording(recording::Recording recording,
                                                const std::filesystem::path& out, const Workers& workers,
                                                const std::atomic<bool>* stop) {
  if (!can_be_prepared(recording)) return recording;
  const std::filesystem::path file = preparation_file(out, recording);
  if (is_kept(out, recording)) {
    const auto kept = calibration::read_calibration(file);
    if (!kept) return tl::unexpected(kept.error());
    return with_timing(std::move(recording), kept->color.timing);
  }
  const auto measured = prepare(recording, workers, stop);
  if (!measured) return tl::unexpected(measured.error());
  const SensorTiming timing = timing_after(*measured);
  keep(file, rig_with_timing(recording, timing));
  return with_timing(std::move(recording), timing);
}

}  // namespace fusebench::preparation
