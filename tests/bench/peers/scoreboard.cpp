#include "tests/bench/peers/scoreboard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::peers {

using namespace text;
using namespace metrics;
using namespace mesh_error;

namespace {

using nlohmann::ordered_json;

double percentile_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return percentile(values, share);
}

std::string task_name(const std::optional<Task>& task) {
  if (!task) return "whole frame";
  return *task == Task::tracking ? "tracking" : "fusion";
}

/// Of entrants that have an answer to give.
bool answers_right(const Entrant& entrant, const ContestResult& result) {
  if (entrant.motion) return is_tracking(*entrant.motion, result.standing_still);
  return !entrant.surface || is_surface(*entrant.surface);
}

/// The median of ours at the same task.
std::optional<double> our_median_ms(const ContestResult& result, const std::optional<Task>& task) {
  for (const Entrant& entrant : result.entrants) {
    if (!entrant.package.empty() || entrant.task != task) continue;
    std::vector<double> all;
    for (const auto& repetition : entrant.cpu_ms) all.insert(all.end(), repetition.begin(), repetition.end());
    if (!all.empty()) return percentile_of(std::move(all), 0.5);
  }
  return std::nullopt;
}

std::string answer_text(const Entrant& entrant, const ContestResult& result) {
  if (!entrant.missing.empty()) return entrant.missing;
  std::string text;
  if (entrant.motion) {
    const MotionAnswer& motion = *entrant.motion;
    text =
        fmt::format("{:.0f} % of {} frames right (medians {:.1f} mm, {:.2f} deg)", 100 * motion.share_right(),
                    motion.frames, 1e3 * motion.median_translation_m, motion.median_rotation_deg);
  }
  if (entrant.surface) {
    const SurfaceAnswer& surface = *entrant.surface;
    text = fmt::format("{} points in {} blocks of {}^3, {:.1f} % near ours", surface.points, surface.blocks,
                       surface.block_side_voxels, 100 * surface.share_near);
  }
  return answers_right(entrant, result) ? text : "WRONG: " + text;
}

std::string sentence(const ContestResult& result, const ContestConditions& conditions) {
  const std::string data = fmt::format(
      "{}, frames {} (the first {} start the estimators and do not count), {} x {} pixels, IMU: {}",
      conditions.recording, conditions.frames, kStartingFrames, conditions.width_px, conditions.height_px,
      conditions.imu);
  const std::string field =
      fmt::format("voxels of {:.0f} mm, truncation {:.0f} mm, {} frames fused",
                  1e3 * conditions.field.voxel_m, 1e3 * conditions.field.truncation_m, result.frames_fused);
  const std::string turns =
      fmt::format("{} repetitions, frame by frame in turn, one thread ({} more started)",
                  conditions.repetitions, result.threads_started);
  return fmt::format("{}; {}; {}; {}; ours built with {}.", data, field, turns, conditions.cpu,
                     conditions.build);
}

ordered_json json_of(const Entrant& entrant, const ContestResult& result) {
  ordered_json document = {{"task", task_name(entrant.task)},
                           {"name", entrant.name},
                           {"settings", entrant.settings},
                           {"package", entrant.package}};
  if (!entrant.missing.empty()) document["missing"] = entrant.missing;
  if (const auto score = score_of(entrant, result)) {
    document["cpu_ms_median"] = score->median_ms;
    document["cpu_ms_p90"] = score->p90_ms;
    document["cpu_ms_mean"] = score->mean_ms;
    document["ratio"] = score->ratio ? ordered_json(*score->ratio) : ordered_json();
    document["cpu_ms_repetition_medians"] = score->repetition_medians_ms;
    document["cpu_ms_frames"] = entrant.cpu_ms;
  }
  if (entrant.motion) {
    const MotionAnswer& motion = *entrant.motion;
    document["motion"] = {{"frames", motion.frames},
                          {"found", motion.found},
                          {"right", motion.right},
                          {"median_translation_m", motion.median_translation_m},
                          {"median_rotation_deg", motion.median_rotation_deg}};
  }
  if (entrant.surface) {
    const SurfaceAnswer& surface = *entrant.surface;
    document["surface"] = {{"blocks", surface.blocks},
                           {"block_side_voxels", surface.block_side_voxels},
                           {"points", surface.points},
                           {"share_near", surface.share_near}};
  }
  return document;
}

}  // namespace

std::optional<Score> score_of(const Entrant& entrant, const ContestResult& result) {
  if (!entrant.missing.empty()) return std::nullopt;
  Score score;
  std::vector<double> all;
  for (const auto& repetition : entrant.cpu_ms) {
    if (repetition.empty()) continue;
    score.repetition_medians_ms.push_back(percentile_of(repetition, 0.5));
    all.insert(all.end(), repetition.begin(), repetition.end());
  }
  if (all.empty()) return std::nullopt;
  score.median_ms = percentile_of(all, 0.5);
  score.mean_ms = statistics(all).mean;
  score.p90_ms = percentile_of(std::move(all), 0.9);
  const auto [least, most] = std::ranges::minmax(score.repetition_medians_ms);
  score.spread = (most - least) / score.median_ms;
  const auto ours_ms = our_median_ms(result, entrant.task);
  if (ours_ms && answers_right(entrant, result)) score.ratio = score.median_ms / *ours_ms;
  return score;
}

std::string scoreboard_text(const ContestResult& result, const ContestConditions& conditions) {
  std::vector<std::vector<std::string>> lines = {
      {"task", "program", "settings", "median ms", "p90 ms", "mean ms", "to ours", "spread", "answer"}};
  for (const std::optional<Task> task : {std::optional(Task::tracking), std::optional(Task::fusion), {}}) {
    for (const Entrant& entrant : result.entrants) {
      if (entrant.task != task) continue;
      auto& line = lines.emplace_back(
          std::vector<std::string>{task_name(task), entrant.name, entrant.settings, "-", "-", "-", "-", "-"});
      if (const auto score = score_of(entrant, result)) {
        line[3] = fmt::format("{:.2f}", score->median_ms);
        line[4] = fmt::format("{:.2f}", score->p90_ms);
        line[5] = fmt::format("{:.2f}", score->mean_ms);
        if (score->ratio) line[6] = fmt::format("{:.2f}x", *score->ratio);
        line[7] = fmt::format("{:.1f} %", 100 * score->spread);
      }
      line.push_back(answer_text(entrant, result));
    }
  }
  return fmt::format(
      "{}\n\n{}\nMilliseconds of CPU of the whole process per frame; \"to ours\" compares medians. Spread: "
      "of the repetitions' medians. "
      "Right: the motion since the frame before is within {:.0f} cm and {:.0f} deg of the ground truth "
      "(standing still would be right in {:.0f} %, with medians of {:.1f} mm and {:.2f} deg). Near: within "
      "{:.0f} cm of the surface of ours.\n",
      sentence(result, conditions), aligned_columns(lines), 1e2 * MotionAnswer::kMostTranslation_m,
      MotionAnswer::kMostRotation_deg, 100 * result.standing_still.share_right(),
      1e3 * result.standing_still.median_translation_m, result.standing_still.median_rotation_deg,
      1e2 * SurfaceAnswer::kMostDistance_m);
}

std::string scoreboard_json(const ContestResult& result, const ContestConditions& conditions) {
  ordered_json document = {{"recording", conditions.recording},
                           {"frames", conditions.frames},
                           {"imu", conditions.imu},
                           {"imu_note", conditions.imu_note},
                           {"width_px", conditions.width_px},
                           {"height_px", conditions.height_px},
                           {"voxel_m", conditions.field.voxel_m},
                           {"truncation_m", conditions.field.truncation_m},
                           {"repetitions", conditions.repetitions},
                           {"threads_started", result.threads_started},
                           {"frames_fused", result.frames_fused},
                           {"cpu", conditions.cpu},
                           {"build", conditions.build},
                           {"standing_still_right", result.standing_still.share_right()}};
  document["entrants"] = ordered_json::array();
  for (const Entrant& entrant : result.entrants) document["entrants"].push_back(json_of(entrant, result));
  return json_text(document) + "\n";
}

}  // namespace fusebench::peers
