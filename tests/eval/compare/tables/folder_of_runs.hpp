// A folder of runs that tables are made of, with numbers that a test knows.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "eval/metrics/intensity_file.hpp"
#include "eval/metrics/intensity_metrics.hpp"
#include "eval/record/record.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

class InFolderOfRuns : public InTemporaryFolder {
 protected:
  void add_run(const std::string& variant, record::RunStatus status, const std::string& reason, double ate_m,
               const std::vector<IntensityResidual>& pixels, const std::string& hash = "01234567") {
    record::RunRecord record;
    record.status = status;
    record.reason = reason;
    record.recording.name = recording_;
    record.recording.fingerprint = recording_;
    record.recording.imu = variant == "no-imu" ? "none" : "synthetic IMU";
    record.variant = variant;
    record.frames = {240, status == record::RunStatus::ok ? 240U : 12U, 0};
    if (status == record::RunStatus::ok) {
      trajectory_error::AteResult ate;
      ate.stats = metrics::statistics(std::vector<double>{ate_m});
      record.metrics.ate = {ate, {}};
      record.metrics.ate_fitted.reason = "the motion does not tell it";
      if (variant == "full") {
        trajectory_error::FittedOffset fit;
        fit.stats = metrics::statistics(std::vector<double>{ate_m / 2});
        record.metrics.ate_fitted = {fit, {}};
      }
      metrics::IntensityAccumulator sums;
      sums.add_frame(pixels);
      record.metrics.aie = {sums.result(), {}};
    }
    const auto run = std::filesystem::path("runs") / recording_ / variant / hash;
    write(run / "record.json", record::to_json(record));
    auto writer = metrics::IntensityWriter::create(folder_ / run / "intensity.bin", 640, 480);
    ASSERT_TRUE(writer && writer->write_frame(1, {}) && writer->write_frame(2, pixels) && writer->finish());
  }

  std::string recording_ = "fr1_rpy";

  /// full and dm share pixel 5; dm drops the hard pixel 7; no-imu is lost.
  void add_three_runs() {
    add_run("no-imu", record::RunStatus::lost, "lost at frame 12: 3 patches, 5 | needed", 0, {});
    add_run("full", record::RunStatus::ok, "", 0.0123, {{5, 2.0F, true}, {7, 10.0F, true}});
    add_run("dm", record::RunStatus::ok, "", 0.05, {{5, 3.0F, true}});
  }
};

}  // namespace fusebench::testing
