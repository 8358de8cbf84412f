#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/geometry.hpp"
#include "core/base/trajectory/trajectory.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/number_checks.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/metrics/trajectory_error/silent_failures.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::cli::evaluation {

namespace {

struct SilentOptions {
  std::string reference;
  std::string estimate;
  double interval_s = 1.0;
  double translation_m = 0.05;
  double rotation_deg = 3.0;
  std::vector<double> offset_m = {0, 0, 0};
  double t_offset_s = 0;
  bool json = false;
};

std::string to_text(const trajectory_error::SilentFailures& found) {
  std::string text = fmt::format(
      "undetected failures: {} of {} poses, whose motion over {:g} s is off by more than {:g} m or {:g} "
      "deg\n",
      found.silent, found.judged, found.limits.interval_s, found.limits.max_translation_m,
      degrees(found.limits.max_rotation_rad));
  if (found.first_ns)
    text += fmt::format("first              {:.6f} s\n", 1e-9 * static_cast<double>(*found.first_ns));
  text += fmt::format("worst translation  {:.6f} m\nworst rotation     {:.6f} deg\n",
                      found.worst_translation_m, degrees(found.worst_rotation_rad));
  return text;
}

std::string to_json(const trajectory_error::SilentFailures& found) {
  using Json = nlohmann::ordered_json;
  const Json json = {{"metric", "silent_failures"},
                     {"interval_s", found.limits.interval_s},
                     {"max_translation_m", found.limits.max_translation_m},
                     {"max_rotation_rad", found.limits.max_rotation_rad},
                     {"judged", found.judged},
                     {"silent", found.silent},
                     {"first_ns", found.first_ns ? Json(*found.first_ns) : Json(nullptr)},
                     {"worst_translation_m", found.worst_translation_m},
                     {"worst_rotation_rad", found.worst_rotation_rad}};
  return text::json_text(json) + "\n";
}

Result<int> run(const SilentOptions& options) {
  const auto sides = trajectories::load_sides(options.reference, options.estimate);
  if (!sides) return tl::unexpected(sides.error());
  if (!sides->have_stamps())
    return fail(ErrorCode::usage, "undetected failures need stamps, which the format kitti does not have",
                "use TUM or EuRoC files");
  const auto found = trajectory_error::silent_failures(
      trajectory::of_point(sides->reference.poses, Vector3d(options.offset_m.data())),
      trajectory::with_clock_offset(sides->estimate.poses, std::llround(1e9 * options.t_offset_s)),
      {options.interval_s, options.translation_m, radians(options.rotation_deg)});
  if (!found) return tl::unexpected(found.error());
  console::print_output(options.json ? to_json(*found) : to_text(*found));
  return 0;
}

}  // namespace

console::Verb add_eval_silent_verb(CLI::App& eval) {
  auto options = std::make_shared<SilentOptions>();
  CLI::App* verb = eval.add_subcommand(
      "silent",
      "Counts undetected failures: poses of an estimate whose motion over the second before is wrong");
  verb->add_option("GT", options->reference, "Reference with stamps (TUM, EuRoC)")->required();
  verb->add_option("EST", options->estimate, "Estimate with stamps; frames that were lost have no pose in it")
      ->required();
  verb->add_option("--interval", options->interval_s, "Interval of the motion that is compared")
      ->type_name("S")
      ->check(console::positive())
      ->capture_default_str();
  verb->add_option("--translation", options->translation_m, "Largest error of its translation")
      ->type_name("M")
      ->check(console::positive())
      ->capture_default_str();
  verb->add_option("--rotation", options->rotation_deg, "Largest error of its rotation")
      ->type_name("DEG")
      ->check(console::positive())
      ->capture_default_str();
  verb->add_option("--offset", options->offset_m,
                   "Position of the camera in the reference's body, as fitted by `eval ate --fit_offset`")
      ->type_name("X Y Z")
      ->expected(3)
      ->capture_default_str();
  verb->add_option("--t_offset", options->t_offset_s, "Added to the estimate's stamps")
      ->type_name("S")
      ->check(console::number_range(-1e6, 1e6))
      ->capture_default_str();
  console::add_json_flag(*verb, options->json);
  verb->footer("docs/metrics.md defines the numbers. Exit code 3 for files that cannot be compared.");
  return {verb, [options] { return run(*options); }};
}

}  // namespace fusebench::cli::evaluation
