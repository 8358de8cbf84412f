#include "eval/report/inspection_report/inspection_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fusebench::inspection_report {

namespace {

class Rows {
 public:
  explicit Rows(std::string group) : group_(std::move(group)) {}
  void add(std::string quantity, std::string value) {
    rows_.push_back({group_, std::move(quantity), std::move(value)});
  }
  void add_stamps(const inspection::StampMeasurement& s) {
    add("count, time", fmt::format("{} in {:.2f} s", s.count, s.duration_s));
    add("rate", fmt::format("{:.2f} Hz (intervals {:.2f} to {:.2f} ms, jitter {:.2f} ms rms)", s.rate_hz,
                            1e3 * s.min_interval_s, 1e3 * s.max_interval_s, 1e3 * s.jitter_rms_s));
    add("missing", fmt::format("{} in {} gaps", s.missing, s.gaps));
  }
  void append_to(std::vector<InspectionRow>& all) { std::ranges::move(rows_, std::back_inserter(all)); }

 private:
  std::string group_;
  std::vector<InspectionRow> rows_;
};

std::string vector_text(const Vector3d& v) {
  return fmt::format("({:.4f}, {:.4f}, {:.4f})", v.x(), v.y(), v.z());
}

void frame_rows(const inspection::Inspection& i, std::vector<InspectionRow>& all) {
  Rows rows("frames");
  rows.add_stamps(i.color_stamps);
  rows.add("colour to depth", fmt::format("{:.1f} ms in the median, {:.1f} ms at most",
                                          1e3 * i.association.median_s, 1e3 * i.association.max_s));
  rows.append_to(all);
}

void image_rows(const inspection::Inspection& i, std::vector<InspectionRow>& all) {
  if (i.images.empty()) return;
  Rows rows("images");
  const inspection::ExposureMeasurement& e = i.exposure;
  rows.add("sampled", fmt::format("{} of {} frames", i.images.size(), i.frames));
  rows.add("brightness", fmt::format("{:.0f} of 255 (drift {:.0f}), {:.1f} % saturated, {:.1f} % dark",
                                     e.mean_grey, e.drift_grey, 100 * e.saturated_share, 100 * e.dark_share));
  rows.add("sharpness", fmt::format("{:.0f} in the median, {:.0f} in the worst twentieth", e.sharpness_median,
                                    e.sharpness_p05));
  rows.append_to(all);
  Rows depth("depth");
  const inspection::DepthMeasurement& d = i.depth;
  depth.add("coverage", fmt::format("{:.0f} % of pixels in the median, {:.0f} % at worst",
                                    100 * d.coverage_median, 100 * d.coverage_min));
  depth.add("range", fmt::format("{:.2f} to {:.2f} m, median {:.2f} m, {:.1f} % beyond 10 m", d.min_m,
                                 d.max_m, d.median_m, 100 * d.beyond_10m_share));
  if (i.registration) {
    const inspection::measures::RegistrationFit& fit = *i.registration;
    depth.add("depth-colour misregistration",
              fmt::format("{:.1f} px +- {:.1f}; a gain of {:.1f} standard deviations of edge strength",
                          fit.moved_px, fit.sigma_px, fit.gain_sigmas));
  }
  depth.append_to(all);
}

void motion_rows(const inspection::Inspection& i, std::vector<InspectionRow>& all) {
  const inspection::MotionMeasurement& m = i.motion;
  if (m.source.empty()) return;
  Rows rows("motion");
  rows.add("angular speed",
           fmt::format("{:.1f} deg/s mean, {:.1f} p95, {:.1f} max", kDegreesPerRadian * m.angular_mean_radps,
                       kDegreesPerRadian * m.angular_p95_radps, kDegreesPerRadian * m.angular_max_radps));
  if (m.linear_mean_mps) {
    rows.add("linear speed", fmt::format("{:.3f} m/s mean, {:.3f} p95, {:.3f} max", *m.linear_mean_mps,
                                         *m.linear_p95_mps, *m.linear_max_mps));
  }
  rows.add("predicted blur",
           fmt::format("{:.1f} px median, {:.1f} p95 in 10 ms", m.blur_median_px, m.blur_p95_px));
  rows.append_to(all);
}

void truth_rows(const inspection::Inspection& i, std::vector<InspectionRow>& all) {
  if (!i.truth) return;
  Rows rows("truth");
  rows.add_stamps(i.truth->stamps);
  rows.add("coverage",
           fmt::format("{:.1f} % of frames; path {:.2f} m", 100 * i.truth->coverage, i.truth->path_m));
  rows.append_to(all);
  if (!i.reprojection) return;
  Rows warped("warped");
  const inspection::ReprojectionMeasurement& r = *i.reprojection;
  warped.add("pairs of frames", fmt::format("{}", r.pairs.size()));
  warped.add("residuals",
             fmt::format("depth {:.1f} mm ({:.2f} %), intensity {:.1f} grey levels (medians)",
                         1e3 * r.depth_residual_m, 100 * r.depth_residual_share, r.intensity_residual_grey));
  for (const inspection::HypothesisResult& h : r.hypotheses) {
    const std::string value = h.value == 0 ? ""
                              : h.code.ends_with("time-offset")
                                  ? fmt::format(", by {:+.1f} ms", 1e3 * h.value)
                                  : fmt::format(", factor {:.3f}", h.value);
    warped.add("hypothesis: " + h.name,
               fmt::format("{} ({:.{}f} times the residuals{})", i.has(h.code) ? "accepted" : "rejected",
                           h.factor, h.factor < 2 ? 2 : 1, value));
  }
  warped.append_to(all);
}

void imu_rows(const inspection::Inspection& i, std::vector<InspectionRow>& all) {
  if (!i.imu) return;
  Rows rows("IMU");
  const inspection::ImuMeasurement& m = *i.imu;
  rows.add_stamps(m.stamps);
  rows.add("largest values",
           fmt::format("{:.0f} deg/s, {:.1f} m/s^2 (one axis)", kDegreesPerRadian * m.gyroscope_max_radps,
                       m.accelerometer_max_mps2));
  if (m.gravity_mps2)
    rows.add("gravity", fmt::format("{:.3f} m/s^2 ({})", *m.gravity_mps2, m.gravity_source));
  if (m.gyroscope_bias_radps)
    rows.add("gyroscope bias",
             fmt::format("{} rad/s ({})", vector_text(*m.gyroscope_bias_radps), m.bias_source));
  if (m.accelerometer_bias_mps2)
    rows.add("accelerometer bias",
             fmt::format("{} m/s^2 (ground truth)", vector_text(*m.accelerometer_bias_mps2)));
  if (i.imu_alignment) {
    const inspection::ImuAlignment& a = *i.imu_alignment;
    rows.add("time offset",
             fmt::format("{:+.2f} ms +- {:.2f} (IMU later than the {}; {} turns)", 1e3 * a.time_offset_s,
                         1e3 * a.time_offset_sigma_s, a.source, a.intervals));
    rows.add("extrinsic rotation", a.rotation_error_rad
                                       ? fmt::format("{:.2f} deg +- {:.2f} off the calibration's",
                                                     kDegreesPerRadian * *a.rotation_error_rad,
                                                     kDegreesPerRadian * a.rotation_sigma_rad)
                                       : "none fits: the axes are mirrored");
    rows.add("gyroscope scale",
             fmt::format("{:.4f}; explains {:.1f} % of the turns", a.scale, 100 * a.explained));
  }
  rows.append_to(all);
}

}  // namespace

std::vector<InspectionRow> inspection_rows(const inspection::Inspection& inspection) {
  std::vector<InspectionRow> rows;
  if (inspection.frames == 0) return rows;
  frame_rows(inspection, rows);
  image_rows(inspection, rows);
  motion_rows(inspection, rows);
  truth_rows(inspection, rows);
  imu_rows(inspection, rows);
  return rows;
}

std::string inspection_title(const inspection::Inspection& i) {
  const auto counted = [](std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  return fmt::format("{} ({}): {}, IMU: {}; {}, {}, {}", i.recording,
                     i.format.empty() ? "format unknown" : i.format, counted(i.frames, "frame"),
                     recording::to_string(i.imu_source),
                     counted(i.count(inspection::Severity::error), "error"),
                     counted(i.count(inspection::Severity::warning), "warning"),
                     counted(i.count(inspection::Severity::note), "note"));
}

std::string to_text(const inspection::Inspection& inspection) {
  std::string text = inspection_title(inspection) + "\n\n";
  std::size_t code_width = 0;
  for (const inspection::Finding& f : inspection.findings) code_width = std::max(code_width, f.code.size());
  for (const inspection::Finding& f : inspection.findings) {
    text +=
        fmt::format("{:<7}  {:<{}}  {}\n", inspection::to_string(f.severity), f.code, code_width, f.message);
    if (!f.hint.empty()) text += fmt::format("{:<7}  {:<{}}  -> {}\n", "", "", code_width, f.hint);
  }
  const std::vector<InspectionRow> rows = inspection_rows(inspection);
  std::size_t quantity_width = 0;
  for (const InspectionRow& row : rows) quantity_width = std::max(quantity_width, row.quantity.size());
  std::string group;
  for (const InspectionRow& row : rows) {
    if (row.group != group) text += "\n";
    text += fmt::format("{:<7}  {:<{}}  {}\n", row.group == group ? "" : row.group, row.quantity,
                        quantity_width, row.value);
    group = row.group;
  }
  return text;
}

}  // namespace fusebench::inspection_report
