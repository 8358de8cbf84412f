#include "eval/record/run_files/filter_tables.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string_view>

#include "core/base/io/stamped_rows.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/trajectory_file.hpp"
#include "core/estimator/filter/sensor_constants.hpp"

namespace fusebench::run_files {

std::string nees_table(const record::RecordedNees& nees) {
  std::string text;
  for (const record::Outcome<metrics::NeesResult>& part : nees) {
    if (!part.value) continue;
    if (text.empty()) text = "# capture_timestamp,part,nees_per_dof\n";
    for (std::size_t i = 0; i < part.value->at_ns.size(); ++i) {
      fmt::format_to(std::back_inserter(text), "{},{},{}\n", trajectory::stamp_text(part.value->at_ns[i]),
                     part.value->part.name, part.value->nees_per_dof[i]);
    }
  }
  return text;
}

Result<std::vector<NeesTableRow>> read_nees_table(const std::filesystem::path& file) {
  std::vector<NeesTableRow> rows;
  const Result<void> done =
      io::for_each_stamped_row(file, "capture_timestamp part nees_per_dof", io::TimeOrder::any,
                               [&](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
                                 NeesTableRow row{time_ns, std::string(table.text(1)), 0};
                                 if (auto read = table.numbers(2, {&row.nees_per_dof, 1}); !read) return read;
                                 rows.push_back(std::move(row));
                                 return {};
                               });
  if (!done) return tl::unexpected(done.error());
  return rows;
}

namespace {

constexpr int kWritten = filter::kGravity;  ///< rotation to accelerometer bias lead the error state

}  // namespace

std::string state_table_header() {
  std::string header =
      "capture_timestamp,status,px_m,py_m,pz_m,qw,qx,qy,qz,vx_mps,vy_mps,vz_mps,bgx_radps,bgy_radps,"
      "bgz_radps,bax_mps2,bay_mps2,baz_mps2,gx,gy,gz";
  for (int i = 0; i < kWritten; ++i) {
    for (int j = i; j < kWritten; ++j) header += fmt::format(",P_{}_{}", i, j);
  }
  for (const filter::SensorConstant& constant : filter::sensor_constants({}, {}))
    header += fmt::format(",{0},sigma_{0}", constant.name);
  return header + "\n";
}

std::string state_table_row(const health::FrameReport& report, const SensorTiming& timing) {
  const filter::FilterState& mean = report.estimate.mean;
  const Quaterniond& q = mean.T_world_imu.rotation;
  std::string row =
      fmt::format("{},{}", trajectory::stamp_text(report.capture_ns), health::to_string(report.status));
  const auto add = [&](const Vector3d& v) {
    fmt::format_to(std::back_inserter(row), ",{},{},{}", v.x(), v.y(), v.z());
  };
  add(mean.T_world_imu.translation);
  fmt::format_to(std::back_inserter(row), ",{},{},{},{}", q.w(), q.x(), q.y(), q.z());
  add(mean.velocity_world_mps);
  add(mean.gyroscope_bias_radps);
  add(mean.accelerometer_bias_mps2);
  add(mean.gravity_direction_world);
  for (int i = 0; i < kWritten; ++i) {
    for (int j = i; j < kWritten; ++j) {
      // Nine digits: enough for any use of a covariance, and half the file.
      fmt::format_to(std::back_inserter(row), ",{:.9g}", report.estimate.covariance(i, j));
    }
  }
  for (const filter::SensorConstant& constant : filter::sensor_constants(report.estimate, timing))
    fmt::format_to(std::back_inserter(row), ",{:.9g},{:.9g}", constant.value, constant.sigma);
  return row + "\n";
}

}  // namespace fusebench::run_files
