#include "eval/report/inspection_report/inspection_thumbnails.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "eval/page/image_source.hpp"

namespace fusebench::inspection_report {

namespace {

constexpr int kWidth_px = 240;
constexpr int kQuality = 80;

cv::Mat small_color(const ColorImage& image, const cv::Size& size) {
  cv::Mat view(image.height, image.width, CV_8UC3, const_cast<Rgb*>(image.data.data()));  // only read
  cv::Mat result;
  cv::resize(view, result, size, 0, 0, cv::INTER_AREA);
  return result;
}

/// Near is red, far is blue, black is without a measurement.
cv::Mat small_depth(const DepthImage& depth_m, const cv::Size& size, double far_m) {
  cv::Mat view(depth_m.height, depth_m.width, CV_32FC1,
               const_cast<float*>(depth_m.data.data()));  // only read
  cv::Mat nearest, grey, colors;
  cv::resize(view, nearest, size, 0, 0, cv::INTER_NEAREST);
  nearest.convertTo(grey, CV_8UC1, -255.0 / std::max(0.1, far_m), 255.0);
  cv::applyColorMap(grey, colors, cv::COLORMAP_TURBO);
  cv::cvtColor(colors, colors, cv::COLOR_BGR2RGB);
  colors.setTo(cv::Scalar(0, 0, 0), nearest <= 0);
  return colors;
}

std::string side_by_side(const RgbdFrame& frame, double far_m) {
  const int height = std::max(1, kWidth_px * frame.color.height / std::max(1, frame.color.width));
  const cv::Size size(kWidth_px, height);
  ColorImage both(2 * kWidth_px, height);
  cv::Mat view(height, 2 * kWidth_px, CV_8UC3, both.data.data());
  small_color(frame.color, size).copyTo(view(cv::Rect(0, 0, kWidth_px, height)));
  small_depth(frame.depth_m, size, far_m).copyTo(view(cv::Rect(kWidth_px, 0, kWidth_px, height)));
  return page::jpeg_source(both, kQuality);
}

/// A pixel for each edge, over what was drawn before.
void draw_edges(const std::vector<inspection::measures::DepthEdge>& edges,
                const inspection::measures::RegistrationModel& model, const PinholeCamera& camera, Rgb color,
                ColorImage& picture) {
  for (const inspection::measures::DepthEdge& edge : edges) {
    const Eigen::Vector2d at = model.move(edge, camera).array().round();
    if (at.x() < 0 || at.y() < 0 || at.x() >= picture.width || at.y() >= picture.height) continue;
    picture(static_cast<int>(at.x()), static_cast<int>(at.y())) = color;
  }
}

std::string edges_on_grey(const RgbdFrame& frame, const inspection::measures::RegistrationModel& model,
                          const PinholeCamera& camera) {
  ColorImage picture(frame.grey.width, frame.grey.height);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto grey = static_cast<std::uint8_t>(0.6F * static_cast<float>(frame.grey(x, y)));
      picture(x, y) = {grey, grey, grey};
    }
  }
  const auto edges = inspection::measures::depth_edges(frame.depth_m);
  draw_edges(edges, {}, camera, {255, 255, 255}, picture);
  draw_edges(edges, model, camera, {255, 60, 60}, picture);
  return page::jpeg_source(picture, kQuality);
}

/// A picture of a frame; of one that was there when it was inspected and is no more, black in its place.
template <class Draw>
page::PageImage picture_of(std::size_t number, const recording::Recording& recording, const Draw& draw) {
  const auto frame = recording.load_frame(number);
  if (frame) return draw(*frame);
  const PinholeCamera& camera = recording.rig.camera;
  return {fmt::format("frame {} could not be read again: {}", number, frame.error().message),
          page::jpeg_source(ColorImage(camera.width_px / 4, camera.height_px / 4), kQuality)};
}

struct Choice {
  std::size_t frame;
  std::string why;
};

std::vector<Choice> chosen_frames(const inspection::Inspection& inspection) {
  const auto& images = inspection.images;
  std::vector<Choice> chosen;
  const auto add = [&](std::size_t frame, std::string why) {
    const bool there = std::ranges::any_of(chosen, [&](const Choice& c) { return c.frame == frame; });
    if (!there) chosen.push_back({frame, std::move(why)});
  };
  for (std::size_t i = 0; i < 4; ++i) add(images[i * (images.size() - 1) / 3].frame, "");
  const auto blurred = std::ranges::min_element(images, {}, &inspection::FrameStatistics::sharpness);
  add(blurred->frame, fmt::format("least sharp: {:.0f}", blurred->sharpness));
  const auto holes = std::ranges::min_element(images, {}, &inspection::FrameStatistics::depth_coverage);
  add(holes->frame, fmt::format("least depth: {:.0f} %", 100 * holes->depth_coverage));
  const auto dark = std::ranges::min_element(images, {}, &inspection::FrameStatistics::mean_grey);
  add(dark->frame, fmt::format("darkest: {:.0f}", dark->mean_grey));
  const auto bright = std::ranges::max_element(images, {}, &inspection::FrameStatistics::mean_grey);
  add(bright->frame, fmt::format("brightest: {:.0f}", bright->mean_grey));
  const auto& speeds = inspection.motion.speeds;
  if (!speeds.empty()) {
    const auto fast = std::ranges::max_element(speeds, {}, &inspection::SpeedSample::blur_px);
    add(fast->frame, fmt::format("fastest: predicted blur {:.0f} px", fast->blur_px));
  }
  return chosen;
}

}  // namespace

std::vector<page::PageImage> inspection_thumbnails(const inspection::Inspection& inspection,
                                                   const recording::Recording& recording) {
  std::vector<page::PageImage> result;
  if (inspection.images.empty()) return result;
  std::vector<double> far;
  for (const inspection::FrameStatistics& frame : inspection.images) far.push_back(frame.depth_p95_m);
  const double far_m = *std::ranges::max_element(far);
  for (const Choice& choice : chosen_frames(inspection)) {
    result.push_back(picture_of(choice.frame, recording, [&](const RgbdFrame& frame) -> page::PageImage {
      const double time_s = seconds_between(recording.frames.front().timestamp_ns, frame.timestamp_ns);
      return {fmt::format("frame {} at {:.2f} s{}{}", choice.frame, time_s, choice.why.empty() ? "" : "; ",
                          choice.why),
              side_by_side(frame, far_m)};
    }));
  }
  return result;
}

std::vector<page::PageImage> registration_pictures(const inspection::Inspection& inspection,
                                                   const recording::Recording& recording) {
  std::vector<page::PageImage> result;
  if (!inspection.registration) return result;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t k = (2 * i + 1) * recording.frames.size() / 8;
    result.push_back(picture_of(k, recording, [&](const RgbdFrame& frame) -> page::PageImage {
      return {fmt::format("frame {}", k),
              edges_on_grey(frame, inspection.registration->model, recording.rig.camera)};
    }));
  }
  return result;
}

}  // namespace fusebench::inspection_report
