#include "eval/report/inspection_report/inspection_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <utility>

#include "core/base/geometry.hpp"
#include "eval/page/page.hpp"
#include "eval/report/inspection_report/inspection_text.hpp"
#include "eval/report/inspection_report/inspection_thumbnails.hpp"

namespace fusebench::inspection_report {

namespace {

constexpr std::size_t kBuckets = 900;  // twice as many points as a chart is wide
constexpr std::string_view kTime = "time [s]";

template <class Sample, class Value>
std::vector<Vector2d> over_time(const std::vector<Sample>& samples, const Value& value) {
  std::vector<Vector2d> points;
  for (const Sample& sample : samples) points.emplace_back(sample.time_s, value(sample));
  return page::thinned(points, kBuckets);
}

page::Chart time_chart(std::string title, std::string left, std::string right = "") {
  page::Chart chart;
  chart.title = std::move(title);
  chart.x_label = kTime;
  chart.left_label = std::move(left);
  chart.right_label = std::move(right);
  return chart;
}

std::vector<page::Chart> motion_charts(const inspection::Inspection& i) {
  std::vector<page::Chart> charts;
  const auto& speeds = i.motion.speeds;
  if (speeds.empty()) return charts;
  if (i.motion.linear_max_mps) {
    page::Chart linear = time_chart("Linear speed", "speed [m/s]");
    linear.series.push_back(
        {"camera, by the " + i.motion.source,
         over_time(speeds, [](const inspection::SpeedSample& s) { return s.linear_mps.value_or(0); })});
    charts.push_back(std::move(linear));
  }
  page::Chart angular = time_chart("Angular speed", "angular speed [deg/s]");
  angular.series.push_back(
      {"camera, by the " + i.motion.source, over_time(speeds, [](const inspection::SpeedSample& s) {
         return kDegreesPerRadian * s.angular_radps;
       })});
  charts.push_back(std::move(angular));
  page::Chart blur = time_chart("Predicted blur", "blur [px]");
  blur.caption = fmt::format(
      "Exposure {:.0f} ms. Fast motion: {:.0f} % of frames at {:.0f} px (a patch's width) or more; here "
      "{:.1f} %.",
      1e3 * inspection::kBlurExposure_s, 100 * inspection::kFastShare, inspection::kSevereBlur_px,
      100 * i.motion.severe_share);
  blur.series.push_back(
      {"predicted", over_time(speeds, [](const inspection::SpeedSample& s) { return s.blur_px; })});
  blur.series.push_back({"severe",
                         {{speeds.front().time_s, inspection::kSevereBlur_px},
                          {speeds.back().time_s, inspection::kSevereBlur_px}}});
  charts.push_back(std::move(blur));
  return charts;
}

page::Chart histogram_chart(const inspection::DepthMeasurement& depth) {
  page::Chart chart;
  chart.title = "Depth of all sampled pixels";
  chart.x_label = "depth [m]";
  chart.left_label = "share [%]";
  chart.caption =
      fmt::format("Bins of {:.1f} m; the last holds everything beyond {:.0f} m.", inspection::kDepthBin_m,
                  inspection::kDepthBin_m * static_cast<double>(inspection::kDepthBins - 1));
  double total = 0;
  std::size_t last = 0;
  for (std::size_t bin = 0; bin < depth.histogram.size(); ++bin) {
    total += static_cast<double>(depth.histogram[bin]);
    if (depth.histogram[bin] > 0) last = bin;
  }
  page::ChartSeries series{"measured pixels", {}, page::SeriesStyle::bars};
  for (std::size_t bin = 0; bin <= last && total > 0; ++bin) {
    series.points.emplace_back((static_cast<double>(bin) + 0.5) * inspection::kDepthBin_m,
                               100 * static_cast<double>(depth.histogram[bin]) / total);
  }
  chart.series.push_back(std::move(series));
  return chart;
}

std::vector<page::Chart> image_charts(const inspection::Inspection& i) {
  std::vector<page::Chart> charts;
  if (i.images.empty()) return charts;
  page::Chart depth = time_chart("Depth", "coverage [%]", "median depth [m]");
  depth.series.push_back(
      {"pixels with depth [%]",
       over_time(i.images, [](const inspection::FrameStatistics& f) { return 100 * f.depth_coverage; })});
  depth.series.push_back(
      {"median depth [m]",
       over_time(i.images, [](const inspection::FrameStatistics& f) { return f.depth_median_m; }),
       page::SeriesStyle::line, true});
  charts.push_back(std::move(depth));
  charts.push_back(histogram_chart(i.depth));
  page::Chart light = time_chart("Exposure and sharpness", "mean brightness [grey levels]",
                                 "variance of the Laplacian [grey levels²]");
  light.series.push_back(
      {"brightness", over_time(i.images, [](const inspection::FrameStatistics& f) { return f.mean_grey; })});
  light.series.push_back(
      {"sharpness", over_time(i.images, [](const inspection::FrameStatistics& f) { return f.sharpness; }),
       page::SeriesStyle::line, true});
  charts.push_back(std::move(light));
  return charts;
}

/// Norms of the IMU's vectors from a second before the first frame to a second after the last.
std::vector<Vector2d> imu_norms(const recording::Recording& recording, Vector3d ImuSample::*member,
                                double factor) {
  const std::int64_t origin_ns = recording.frames.front().timestamp_ns;
  const std::int64_t end_ns = recording.frames.back().timestamp_ns + 1'000'000'000;
  std::vector<Vector2d> points;
  for (const ImuSample& sample : recording.imu) {
    if (sample.timestamp_ns < origin_ns - 1'000'000'000 || sample.timestamp_ns > end_ns) continue;
    points.emplace_back(seconds_between(origin_ns, sample.timestamp_ns), factor * (sample.*member).norm());
  }
  return page::thinned(points, kBuckets);
}

std::vector<page::Chart> imu_charts(const inspection::Inspection& i, const recording::Recording& recording) {
  page::Chart turning = time_chart("Rotation: gyroscope and camera", "angular speed [deg/s]");
  if (i.imu_alignment) {  // first, since what comes first is drawn on top
    const inspection::ImuAlignment& a = *i.imu_alignment;
    turning.series.push_back(
        {"camera, by the " + a.source,
         over_time(a.rates, [](const inspection::TurnRate& r) { return kDegreesPerRadian * r.camera_radps; }),
         page::SeriesStyle::dots});
    turning.caption = fmt::format("The IMU's clock is {:+.2f} ms (+- {:.2f}) later.", 1e3 * a.time_offset_s,
                                  1e3 * a.time_offset_sigma_s);
  }
  turning.series.push_back(
      {"gyroscope", imu_norms(recording, &ImuSample::angular_velocity_radps, kDegreesPerRadian)});
  page::Chart force = time_chart("Specific force", "specific force [m/s²]");
  force.from_zero = false;
  force.series.push_back({"accelerometer", imu_norms(recording, &ImuSample::specific_force_mps2, 1)});
  if (!force.series.front().points.empty()) {
    const auto& points = force.series.front().points;
    force.series.push_back(
        {"9.81 m/s²", {{points.front().x(), kGravity_mps2}, {points.back().x(), kGravity_mps2}}});
  }
  return {std::move(turning), std::move(force)};
}

template <class Entries, class Member>
std::vector<Vector2d> intervals(const Entries& entries, Member member, std::int64_t origin_ns) {
  std::vector<Vector2d> points;
  for (std::size_t k = 1; k < entries.size(); ++k) {
    points.emplace_back(seconds_between(origin_ns, entries[k].*member),
                        1e3 * seconds_between(entries[k - 1].*member, entries[k].*member));
  }
  return page::thinned(points, kBuckets);
}

std::vector<page::Chart> stamp_charts(const recording::Recording& recording) {
  const std::int64_t origin_ns = recording.frames.front().timestamp_ns;
  page::Chart frames = time_chart("Intervals between frames", "interval [ms]");
  frames.series.push_back(
      {"colour stamps", intervals(recording.frames, &recording::FrameEntry::timestamp_ns, origin_ns)});
  frames.series.push_back(
      {"depth stamps", intervals(recording.frames, &recording::FrameEntry::depth_timestamp_ns, origin_ns)});
  std::vector<page::Chart> charts{std::move(frames)};
  page::Chart others = time_chart("Intervals between samples", "interval [ms]");
  if (!recording.imu.empty())
    others.series.push_back({"IMU", intervals(recording.imu, &ImuSample::timestamp_ns, origin_ns)});
  if (!recording.ground_truth.empty())
    others.series.push_back(
        {"ground truth", intervals(recording.ground_truth, &StampedPose::timestamp_ns, origin_ns)});
  if (!others.series.empty()) charts.push_back(std::move(others));
  return charts;
}

page::Chart residual_chart(const inspection::ReprojectionMeasurement& r,
                           const recording::Recording& recording) {
  page::Chart chart = time_chart("Residuals of frames warped by the ground truth", "depth [% of the depth]",
                                 "intensity [grey levels]");
  chart.caption = "Medians over the pixels of each pair of frames.";
  page::ChartSeries depth{"depth", {}, page::SeriesStyle::dots},
      intensity{"intensity", {}, page::SeriesStyle::dots, true};
  for (const inspection::ReprojectionPair& pair : r.pairs) {
    const double time_s =
        seconds_between(recording.frames.front().timestamp_ns, recording.frames[pair.from].timestamp_ns);
    depth.points.emplace_back(time_s, 100 * pair.depth_residual_share);
    intensity.points.emplace_back(time_s, pair.intensity_residual_grey);
  }
  chart.series = {std::move(depth), std::move(intensity)};
  return chart;
}

page::PageTable findings_table(const inspection::Inspection& inspection) {
  page::PageTable table{{"", "code", "finding", "what to do"}, {}};
  for (const inspection::Finding& f : inspection.findings) {
    const std::string severity(inspection::to_string(f.severity));
    table.rows.push_back({{severity, f.code, f.message, f.hint}, severity});
  }
  return table;
}

page::PageTable measurement_table(const inspection::Inspection& inspection) {
  page::PageTable table;
  std::string group;
  for (const InspectionRow& row : inspection_rows(inspection)) {
    table.rows.push_back({{row.group == group ? "" : row.group, row.quantity, row.value}, ""});
    group = row.group;
  }
  return table;
}

}  // namespace

std::string to_page(const inspection::Inspection& inspection, const recording::Recording& recording) {
  page::Page page;
  page.title = inspection.recording;
  page.subtitle = inspection_title(inspection);
  const auto add_charts = [&](std::string title, std::vector<page::Chart> charts) {
    if (!charts.empty()) page.sections.push_back({std::move(title), "", std::move(charts)});
  };
  page.sections.push_back(
      {"Findings", inspection.findings.empty() ? "None." : "", findings_table(inspection)});
  add_charts("Motion", motion_charts(inspection));
  if (inspection.imu) add_charts("IMU", imu_charts(inspection, recording));
  add_charts("Images and depth", image_charts(inspection));
  add_charts("Stamps", stamp_charts(recording));
  if (inspection.reprojection)
    add_charts("Calibration", {residual_chart(*inspection.reprojection, recording)});
  page.sections.push_back({"Frames", "Colour and depth (near is red, far is blue, black has no measurement).",
                           inspection_thumbnails(inspection, recording)});
  if (inspection.registration) {
    page.sections.push_back(
        {"Depth on colour",
         fmt::format("Borders of near objects in depth: white as read, red moved by {:.1f} px (rms) to the "
                     "best fit of the depth camera. White should coincide with edges of the image.",
                     inspection.registration->moved_px),
         registration_pictures(inspection, recording)});
  }
  page.sections.push_back({"Measurements", "", measurement_table(inspection)});
  return page::to_html(page);
}

}  // namespace fusebench::inspection_report
