#include "eval/report/frame_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "eval/page/image_source.hpp"
#include "eval/report/narrowed_image.hpp"

namespace fusebench::report {

namespace {

constexpr const char* kTitle = "What the camera saw";
constexpr int kPictureWidth_px = 400;
constexpr int kStripWidth_px = 160;
constexpr std::size_t kMostWorst = 3;  // runs whose worst frame is shown

/// A frame to show, with what it is.
struct Choice {
  std::size_t frame = 0;  ///< counted from the first of the run's window
  double time_s = 0;
  std::string caption;
};

std::string source_of(const ColorImage& image, int width_px) {
  constexpr int kQuality = 75;
  return page::jpeg_source(narrowed(image, width_px), kQuality);
}

ColorImage color_of(const GreyImage& grey) {
  ColorImage color(grey.width, grey.height);
  for (int y = 0; y < grey.height; ++y) {
    for (int x = 0; x < grey.width; ++x) {
      const auto value = grey(x, y);
      color(x, y) = Rgb{value, value, value};
    }
  }
  return color;
}

/// The run's frame of a pose; stamps of trajectories are rounded.
std::size_t frame_at(const run_charts::RunSeries& run, std::int64_t timestamp_ns) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < run.frames.size(); ++i) {
    if (std::abs(run.frames[i].timestamp_ns - timestamp_ns) <
        std::abs(run.frames[best].timestamp_ns - timestamp_ns))
      best = i;
  }
  return best;
}

/// The number of a frame of the run's window in its recording.
std::size_t number_of(const run_charts::RunSeries& run, std::size_t frame) {
  return run.run->record.recording.first_frame + frame;
}

Choice choice_of(const run_charts::RunSeries& run, std::size_t frame, std::string what) {
  const double time_s = run.time_s(run.frames[frame].timestamp_ns);
  return {frame, time_s, fmt::format("{}frame {}", what.empty() ? "" : what + ", ", number_of(run, frame))};
}

/// framed: has the frames of the run's window, which an imported run has not.
std::optional<Choice> worst_of(const run_charts::RunSeries& run, const run_charts::RunSeries& framed) {
  const run_charts::ComparedPose* worst = nullptr;
  for (const run_charts::ComparedPose& pose : run.poses) {
    if (pose.T_truth_truth && (worst == nullptr || pose.error_m > worst->error_m)) worst = &pose;
  }
  if (worst == nullptr) return std::nullopt;
  return choice_of(framed, frame_at(framed, worst->timestamp_ns),
                   fmt::format("largest error of {}, {:.2f} cm", run.label, 100 * worst->error_m));
}

/// The first frame, and the worst of some runs.
std::vector<Choice> scene_choices(std::span<const run_charts::RunSeries> runs,
                                  const run_charts::RunSeries& framed) {
  std::vector<Choice> choices = {choice_of(framed, 0, "the scene as it is seen first")};
  for (const run_charts::RunSeries& run : runs) {
    if (choices.size() > kMostWorst) break;
    if (auto worst = worst_of(run, framed)) choices.push_back(std::move(*worst));
  }
  return choices;
}

std::vector<page::PageImage> images_of(const std::vector<Choice>& choices,
                                       const std::map<std::size_t, const ColorImage*>& images, int width_px) {
  std::vector<page::PageImage> result;
  for (const Choice& choice : choices)
    result.push_back({choice.caption, source_of(*images.at(choice.frame), width_px), choice.time_s});
  return result;
}

/// Of the frames that runs kept with their patches, each once.
std::vector<page::PageImage> kept_images(std::size_t first_frame, const run_charts::RunSeries* framed,
                                         std::span<const LabelledPatches> patches) {
  std::map<std::size_t, page::PageImage> images;
  for (const LabelledPatches& run : patches) {
    for (const run_files::PatchTableFrame& frame : run.frames) {
      if (images.contains(frame.frame)) continue;
      images[frame.frame] = {fmt::format("frame {}", first_frame + frame.frame),
                             source_of(color_of(frame.grey), kPictureWidth_px), std::nullopt};
      if (framed != nullptr) images[frame.frame].time_s = framed->time_s(frame.timestamp_ns);
    }
  }
  std::vector<page::PageImage> result;
  for (auto& [frame, image] : images) result.push_back(std::move(image));
  return result;
}

/// Evenly from the first frame to the last.
std::vector<Choice> choices_between(const run_charts::RunSeries& framed, std::size_t most) {
  std::vector<Choice> choices;
  const std::size_t count = std::min(most, framed.frames.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t frame = k * (framed.frames.size() - 1) / std::max<std::size_t>(count - 1, 1);
    choices.push_back(choice_of(framed, frame, ""));
  }
  return choices;
}

Result<std::vector<page::PageSection>> read_pictures(const record::RecordedRecording& recording,
                                                     const std::vector<Choice>& scene,
                                                     const std::vector<Choice>& between,
                                                     const FrameReader& reader) {
  std::set<std::size_t> numbers;
  for (const std::vector<Choice>* choices : {&scene, &between}) {
    for (const Choice& choice : *choices) numbers.insert(choice.frame);
  }
  const std::vector<std::size_t> frames(numbers.begin(), numbers.end());
  const auto read = reader(recording, frames);
  if (!read) return tl::unexpected(read.error());
  std::map<std::size_t, const ColorImage*> images;
  for (std::size_t i = 0; i < frames.size(); ++i) images[frames[i]] = &(*read)[i];
  std::vector<page::PageSection> sections = {{kTitle, "", images_of(scene, images, kPictureWidth_px), 3,
                                              false, std::max<std::size_t>(scene.size(), 3)}};
  if (!between.empty()) {
    sections.push_back({"Frames over time", "", images_of(between, images, kStripWidth_px), 3});
    sections.back().strip = true;
  }
  return sections;
}

}  // namespace

std::vector<page::PageSection> frame_pictures(const record::RecordedRecording& recording,
                                              std::span<const run_charts::RunSeries> runs,
                                              std::span<const LabelledPatches> patches,
                                              std::size_t in_between, const FrameReader& reader,
                                              std::vector<std::string>& warnings) {
  const auto longest =
      std::ranges::max_element(runs, {}, [](const run_charts::RunSeries& run) { return run.frames.size(); });
  const run_charts::RunSeries* const framed =
      longest == runs.end() || longest->frames.empty() ? nullptr : &*longest;
  std::string why = framed == nullptr ? "no run has a table of its frames" : "it was not looked for";
  std::string remedy;
  if (framed != nullptr && reader) {
    auto sections =
        read_pictures(recording, scene_choices(runs, *framed), choices_between(*framed, in_between), reader);
    if (sections) return std::move(*sections);
    why = sections.error().message;
    remedy = sections.error().hint;
    warnings.push_back(fmt::format("{}: no images of the recording ({}){}{}", recording.name, why,
                                   remedy.empty() ? "" : ": ", remedy));
  }
  if (!remedy.empty()) remedy = fmt::format(" {}.", remedy);
  std::vector<page::PageImage> kept = kept_images(recording.first_frame, framed, patches);
  const std::string sentence = fmt::format("No images of the recording ({}).{}", why, remedy);
  if (kept.empty()) return {{kTitle, sentence, page::PageParagraphs{}, 3}};
  return {{kTitle, sentence + " These are the frames that runs kept with their patches.", std::move(kept), 3,
           false, 4}};
}

}  // namespace fusebench::report
