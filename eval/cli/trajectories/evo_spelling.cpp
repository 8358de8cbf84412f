#include "eval/cli/trajectories/evo_spelling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "core/base/printable.hpp"
#include "eval/cli/trajectories/alignment_options.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"

namespace fusebench::cli::trajectories {

namespace {

struct WithoutCounterpart {
  std::string_view flag;
  std::string_view verb;  ///< of one alone; empty: of all
  std::string_view instead;
};
constexpr std::string_view kTransform =
    "`evo_traj` transforms trajectories; with --save_as_tum it writes what this verb reads";
constexpr std::array kWithoutCounterpart{
    WithoutCounterpart{"--rerun", "", "--save_plot FILE.svg draws a picture"},
    WithoutCounterpart{"--rerun_rec_id", "", "--save_plot FILE.svg draws a picture"},
    WithoutCounterpart{"--map_tile", "", "--save_plot FILE.svg draws a picture without a map"},
    WithoutCounterpart{"--ros_map_yaml", "", "--save_plot FILE.svg draws a picture without a map"},
    WithoutCounterpart{"--config", "", "write the options on the command line, for instance in a script"},
    WithoutCounterpart{"-c", "", "write the options on the command line, for instance in a script"},
    WithoutCounterpart{"--plot_markers", "res", "curves are drawn as lines"},
    WithoutCounterpart{"--merge", "traj",
                       "`evo_traj` merges trajectories; with --save_as_tum it writes what this verb reads"},
    WithoutCounterpart{"--transform_left", "traj", kTransform},
    WithoutCounterpart{"--transform_right", "traj", kTransform},
    WithoutCounterpart{"--propagate_transform", "traj", kTransform},
    WithoutCounterpart{"--invert_transform", "traj", kTransform},
    WithoutCounterpart{"--save_as_bag", "traj",
                       "--save_as_tum writes text, which `evo_traj tum` writes as a bag"},
    WithoutCounterpart{"--save_as_bag2", "traj",
                       "--save_as_tum writes text, which `evo_traj tum` writes as a bag"},
};

/// Options of TUM's evaluate_ate.py and evaluate_rpe.py, and what to use instead.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kOfTumScripts = {
    {{"--max_difference", "use --t_max_diff"},
     {"--offset", "use --t_offset"},
     {"--fixed_delta", "it is the default of --protocol tum; --delta sets its length"},
     {"--scale",
      "--scale of TUM's scripts multiplies the positions of the estimate: write them in metres; "
      "--correct_scale fits the scale"}}};

bool is_picture(std::string_view argument) {
  constexpr std::array<std::string_view, 6> kEndings = {".svg", ".pdf", ".png", ".jpg", ".jpeg", ".eps"};
  return std::ranges::find(kEndings, std::filesystem::path(argument).extension().string()) != kEndings.end();
}

bool is_alignment(std::string_view argument) {
  return std::ranges::any_of(kAlignments, [&](const auto& entry) { return argument == entry.first; });
}

/// --align without a mode is a flag, behind which files may stand. A word that is none of these, nor the path
/// of a file that is absent, was meant as a mode.
Result<void> check_mode(const std::string& word) {
  std::error_code ignored;
  const bool other = word.starts_with("-") || word.find_first_of("./") != std::string::npos ||
                     trajectory_files::parse_trajectory_format(word) ||
                     std::filesystem::exists(word, ignored);
  if (other || is_alignment(word)) return {};
  std::vector<std::string_view> modes;
  for (const auto& [name, mode] : kAlignments) modes.emplace_back(name);
  return fail(ErrorCode::usage,
              fmt::format("no alignment '{}' (allowed {}){}", printable(word), fmt::join(modes, ", "),
                          nearest_hint(word, modes)),
              "--align without a mode is se3; a file may follow it then, and there is none of this name");
}

/// Flags in one, "-vap", of which the last one draws.
bool ends_with_plot(std::string_view argument) {
  return argument.size() >= 2 && argument[0] == '-' && argument.back() == 'p' &&
         argument.find_first_not_of("vasfp", 1) == std::string_view::npos;
}

Result<void> check_counterpart(std::string_view argument, std::string_view verb) {
  const std::string_view name = argument.substr(0, argument.find('='));
  for (const WithoutCounterpart& entry : kWithoutCounterpart) {
    if (name != entry.flag || (!entry.verb.empty() && entry.verb != verb)) continue;
    return fail(ErrorCode::usage, fmt::format("evo's {} has no counterpart here", entry.flag),
                std::string(entry.instead));
  }
  for (const auto& [flag, instead] : kOfTumScripts) {
    if (name == flag && (verb == "ate" || verb == "rpe"))
      return fail(ErrorCode::usage,
                  fmt::format("{} is an option of TUM's scripts, not of `eval {}`", flag, verb),
                  std::string(instead));
  }
  return {};
}

/// A bag is named by the first argument that is no flag.
Result<void> check_no_bag(const std::vector<std::string>& arguments) {
  const auto first = std::find_if(arguments.begin() + 2, arguments.end(),
                                  [](const std::string& argument) { return !argument.starts_with("-"); });
  constexpr std::array<std::string_view, 3> kBags = {"bag", "bag2", "mcap"};
  std::error_code ignored;
  if (first == arguments.end() || std::ranges::find(kBags, *first) == kBags.end() ||
      std::filesystem::is_regular_file(*first, ignored))
    return {};
  return fail(
      ErrorCode::usage, fmt::format("{}: bags are not read", *first),
      fmt::format("`evo_traj {} BAG TOPIC... --save_as_tum` writes the poses of each topic as text", *first));
}

}  // namespace

std::string_view name_in_evo(std::string_view verb) { return verb == "ate" ? "ape" : ""; }

Result<std::vector<std::string>> with_own_spelling(std::vector<std::string> arguments) {
  if (arguments.size() < 2 || arguments[0] != "eval") return arguments;
  if (arguments[1] == name_in_evo("ate")) arguments[1] = "ate";
  constexpr std::array<std::string_view, 4> kVerbs = {"ate", "rpe", "traj", "res"};
  if (std::ranges::find(kVerbs, arguments[1]) == kVerbs.end()) return arguments;
  if (auto read = check_no_bag(arguments); !read) return tl::unexpected(read.error());
  std::vector<std::string> spelled(arguments.begin(), arguments.begin() + 2);
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    std::string& argument = arguments[i];
    if (auto known = check_counterpart(argument, arguments[1]); !known) return tl::unexpected(known.error());
    const bool has_next = i + 1 < arguments.size();
    if (argument == "--align" && has_next) {
      if (auto allowed = check_mode(arguments[i + 1]); !allowed) return tl::unexpected(allowed.error());
    }
    if (argument == "--align" && !(has_next && is_alignment(arguments[i + 1]))) {
      spelled.emplace_back("-a");
    } else if (argument == "--plot" && !(has_next && is_picture(arguments[i + 1]))) {
      spelled.emplace_back("-p");
    } else if (ends_with_plot(argument) && has_next && is_picture(arguments[i + 1])) {
      argument.pop_back();
      if (argument != "-") spelled.push_back(std::move(argument));
      spelled.emplace_back("--plot");
    } else {
      spelled.push_back(std::move(argument));
    }
  }
  return spelled;
}

Result<void> take_leading_format(std::vector<std::string>& files, std::string& format) {
  if (files.empty()) return {};
  const std::string first = files.front();
  std::error_code ignored;
  if (std::filesystem::is_regular_file(first, ignored)) return {};
  if (!trajectory_files::parse_trajectory_format(first)) return {};
  if (!format.empty())
    return fail(ErrorCode::usage, "the format is given twice, before the files and with --format");
  format = first;
  files.erase(files.begin());
  return {};
}

}  // namespace fusebench::cli::trajectories
