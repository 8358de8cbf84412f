#include "eval/record/run_files/run_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

namespace fusebench::run_files {

namespace {

using Option = RunOptions::value_type;

/// The edited options that every run has which wrote its options.
std::set<Option> options_of_all(std::span<const RunIdentity> runs) {
  std::map<Option, std::size_t> uses;
  std::size_t writers = 0;
  for (const RunIdentity& run : runs) {
    if (!run.wrote_options) continue;
    ++writers;
    for (const Option& option : run.options) ++uses[option];
  }
  std::set<Option> shared;
  for (const auto& [option, count] : uses) {
    if (count == writers) shared.insert(option);
  }
  return shared;
}

void append(std::string& text, std::string_view words) {
  if (words.empty()) return;
  if (!text.empty()) text += " ";
  text += words;
}

std::string imu_words(const std::string& imu) {
  if (imu == "none") return "no IMU";
  if (imu == "not said") return "IMU not said";  // an imported run
  return imu == "recorded" ? "recorded IMU" : imu;
}

using Window = std::pair<std::size_t, std::size_t>;  // first frame, frames

/// The windows that runs of a recording processed.
struct Windows {
  std::set<Window> windows;
  std::size_t whole_frames = 0;  ///< of the recording; without records of it the end of the last window
};

/// The different values among runs of one variant over one recording.
struct Differences {
  std::set<std::size_t> repetitions;
  std::set<std::size_t> replicates;
  std::set<std::string> imus;
};

}  // namespace

RunSet::RunSet(std::span<const FoundRun> runs) {
  runs_.reserve(runs.size());
  for (const FoundRun& run : runs) runs_.push_back(identity_of(run));
}

std::vector<std::string> RunSet::differing_options() const {
  const std::set<Option> shared = options_of_all(runs_);
  std::vector<std::string> texts(runs_.size());
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    for (const Option& option : runs_[i].options) {
      if (!shared.contains(option)) append(texts[i], fmt::format("{}={}", option.first, option.second));
    }
  }
  return texts;
}

std::string RunSet::shared_options() const {
  std::string text;
  for (const auto& [key, value] : options_of_all(runs_)) append(text, fmt::format("{}={}", key, value));
  return text;
}

std::vector<std::string> RunSet::window_labels() const {
  std::map<std::string, Windows> windows;
  for (const RunIdentity& run : runs_) {
    if (run.frames == 0) continue;
    Windows& of_recording = windows[run.recording];
    of_recording.whole_frames =
        std::max({of_recording.whole_frames, run.whole_frames, run.first_frame + run.frames});
    of_recording.windows.emplace(run.first_frame, run.frames);
  }
  std::vector<std::string> texts(runs_.size());
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const auto found = windows.find(runs_[i].recording);
    if (found == windows.end()) continue;
    const auto& [of_recording, whole_frames] = found->second;
    const Window whole(0, whole_frames);
    Window window(runs_[i].first_frame, runs_[i].frames);
    if (window == Window(0, 0) && of_recording.contains(whole)) window = whole;
    if (window.second == 0) {
      const auto next = of_recording.lower_bound(window);
      window = next == of_recording.end() ? *of_recording.begin() : *next;
    }
    if (window != whole) texts[i] = fmt::format("frames {}:{}", window.first, window.first + window.second);
  }
  return texts;
}

std::vector<std::string> RunSet::imus() const {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> of_recording;
  std::map<std::string, std::set<std::string>> of_variant;
  for (const RunIdentity& run : runs_) {
    if (!run.opened_recording()) continue;
    of_recording[{run.recording, run.variant}].insert(run.imu);
    of_variant[run.variant].insert(run.imu);
  }
  std::vector<std::string> imus;
  for (const RunIdentity& run : runs_) {
    std::set<std::string> likely = {run.imu};
    if (!run.opened_recording()) {
      const auto here = of_recording.find({run.recording, run.variant});
      likely = here != of_recording.end() ? here->second : of_variant[run.variant];
    }
    imus.push_back(likely.size() == 1 ? *likely.begin() : "");
  }
  return imus;
}

std::vector<std::string> RunSet::methods() const {
  const std::vector<std::string> options = differing_options();
  std::vector<std::string> methods;
  for (std::size_t i = 0; i < runs_.size(); ++i) append(methods.emplace_back(runs_[i].variant), options[i]);
  return methods;
}

std::vector<std::string> RunSet::configuration_labels() const {
  const std::vector<std::string> used = imus();
  std::map<std::string, std::set<std::string>> of_variant;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (!used[i].empty()) of_variant[runs_[i].variant].insert(used[i]);
  }
  std::vector<std::string> labels = methods();
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (!used[i].empty() && of_variant.at(runs_[i].variant).size() > 1) append(labels[i], imu_words(used[i]));
  }
  return labels;
}

std::vector<std::string> RunSet::distinctions() const {
  std::map<std::pair<std::string, std::string>, Differences> of_variant;
  for (const RunIdentity& run : runs_) {
    Differences& differences = of_variant[{run.recording, run.variant}];
    differences.repetitions.insert(run.repetition);
    differences.replicates.insert(run.replicate);
    if (run.opened_recording()) differences.imus.insert(run.imu);
  }
  const std::vector<std::string> windows = window_labels();
  std::map<std::string, std::set<std::string>> of_recording;
  for (std::size_t i = 0; i < runs_.size(); ++i) of_recording[runs_[i].recording].insert(windows[i]);
  std::vector<std::string> texts = differing_options();
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> uses;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const RunIdentity& run = runs_[i];
    const Differences& differences = of_variant.at({run.recording, run.variant});
    if (run.frames > 0 && of_recording.at(run.recording).size() > 1) append(texts[i], windows[i]);
    if (differences.repetitions.size() > 1) append(texts[i], fmt::format("repetition {}", run.repetition));
    if (differences.replicates.size() > 1) append(texts[i], fmt::format("replicate {}", run.replicate));
    if (run.opened_recording() && differences.imus.size() > 1) append(texts[i], imu_words(run.imu));
    ++uses[{run.recording, run.variant, texts[i]}];
  }
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (uses.at({runs_[i].recording, runs_[i].variant, texts[i]}) < 2) continue;
    append(texts[i], fmt::format("({})", runs_[i].run));
  }
  return texts;
}

std::vector<std::string> RunSet::labels() const {
  std::vector<std::string> labels = distinctions();
  for (std::size_t i = 0; i < runs_.size(); ++i)
    labels[i] = labels[i].empty() ? runs_[i].variant : fmt::format("{} {}", runs_[i].variant, labels[i]);
  return labels;
}

std::vector<std::vector<std::size_t>> RunSet::replicate_groups() const {
  std::vector<std::vector<std::size_t>> groups;
  struct OpenGroup {
    std::size_t index = 0;
    std::set<std::size_t> replicates = {};
  };
  std::map<RunIdentity, OpenGroup> open;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    OpenGroup& group = open[without_replicate(runs_[i])];
    if (group.replicates.empty() || !group.replicates.insert(runs_[i].replicate).second) {
      group = {groups.size(), {runs_[i].replicate}};
      groups.emplace_back();
    }
    groups[group.index].push_back(i);
  }
  for (auto& group : groups)
    std::ranges::stable_sort(group, {}, [&](std::size_t i) { return runs_[i].replicate; });
  return groups;
}

}  // namespace fusebench::run_files
