#include "eval/run_files/run_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <variant>

namespace fusebench::run_files {

namespace {

using Edit = std::pair<std::string, std::string>;

std::string value_text(const config::OptionValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

/// The edits that every run has which knows its options.
std::set<Edit> edits_of_all(std::span<const RunTraits> runs) {
  std::map<Edit, std::size_t> uses;
  std::size_t knowing = 0;
  for (const RunTraits& run : runs) {
    if (!run.options_known) continue;
    ++knowing;
    for (const Edit& edit : run.edits) ++uses[edit];
  }
  std::set<Edit> shared;
  for (const auto& [edit, count] : uses) {
    if (count == knowing) shared.insert(edit);
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

/// What runs of one variant over one recording have of each kind.
struct Kinds {
  std::set<int> repetitions;
  std::set<int> replicates;
  std::set<std::string> imus;
};

}  // namespace

bool is_edit(std::string_view origin) { return origin != "default" && !origin.starts_with("variant "); }

RunTraits traits_of(const FoundRun& run) {
  const record::RunRecord& record = run.record;
  RunTraits traits;
  traits.recording = record.recording.name;
  traits.variant = record.variant;
  for (const record::RecordedOption& option : record.config) {
    if (is_edit(option.origin)) traits.edits.emplace_back(option.key, value_text(option.value));
  }
  traits.options_known = !record.config.empty() && !record.program;
  traits.first_frame = record.recording.first_frame;
  traits.frames = record.recording.frames;
  traits.repetition = record.repetition;
  traits.replicate = record.replicate;
  if (!record.recording.fingerprint.empty()) traits.imu = record.recording.imu;
  traits.folder = run.folder.filename().string();
  return traits;
}

std::vector<RunTraits> traits_of(std::span<const FoundRun> runs) {
  std::vector<RunTraits> traits;
  traits.reserve(runs.size());
  for (const FoundRun& run : runs) traits.push_back(traits_of(run));
  return traits;
}

std::vector<std::string> differing_edits(std::span<const RunTraits> runs) {
  const std::set<Edit> shared = edits_of_all(runs);
  std::vector<std::string> texts(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const Edit& edit : runs[i].edits) {
      if (!shared.contains(edit)) append(texts[i], fmt::format("{}={}", edit.first, edit.second));
    }
  }
  return texts;
}

std::string shared_edits(std::span<const RunTraits> runs) {
  std::string text;
  for (const auto& [key, value] : edits_of_all(runs)) append(text, fmt::format("{}={}", key, value));
  return text;
}

std::vector<std::string> window_labels(std::span<const RunTraits> runs) {
  std::map<std::string, std::set<std::pair<std::size_t, std::size_t>>> windows;
  for (const RunTraits& run : runs) {
    if (run.frames > 0) windows[run.recording].emplace(run.first_frame, run.frames);
  }
  std::vector<std::string> texts(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto of_recording = windows.find(runs[i].recording);
    if (of_recording == windows.end() || of_recording->second.size() < 2) continue;
    std::pair window(runs[i].first_frame, runs[i].frames);
    if (window.second == 0) {
      const auto next = of_recording->second.lower_bound(window);
      window = next == of_recording->second.end() ? *of_recording->second.begin() : *next;
    }
    texts[i] = fmt::format("frames {}:{}", window.first, window.first + window.second);
  }
  return texts;
}

std::vector<std::string> imus_of_methods(std::span<const RunTraits> runs) {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> of_recording;
  std::map<std::string, std::set<std::string>> of_variant;
  for (const RunTraits& run : runs) {
    if (run.imu.empty()) continue;
    of_recording[{run.recording, run.variant}].insert(run.imu);
    of_variant[run.variant].insert(run.imu);
  }
  std::vector<std::string> imus;
  for (const RunTraits& run : runs) {
    std::set<std::string> likely = {run.imu};
    if (run.imu.empty()) {
      const auto here = of_recording.find({run.recording, run.variant});
      likely = here != of_recording.end() ? here->second : of_variant[run.variant];
    }
    imus.push_back(likely.size() == 1 ? *likely.begin() : "");
  }
  return imus;
}

std::vector<std::string> configuration_labels(std::span<const RunTraits> runs) {
  const std::vector<std::string> edits = differing_edits(runs);
  const std::vector<std::string> imus = imus_of_methods(runs);
  std::map<std::string, std::set<std::string>> of_variant;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!imus[i].empty()) of_variant[runs[i].variant].insert(imus[i]);
  }
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string& label = labels.emplace_back(runs[i].variant);
    append(label, edits[i]);
    if (!imus[i].empty() && of_variant.at(runs[i].variant).size() > 1) append(label, imu_words(imus[i]));
  }
  return labels;
}

std::vector<std::string> distinctions(std::span<const RunTraits> runs) {
  std::map<std::pair<std::string, std::string>, Kinds> of_variant;
  for (const RunTraits& run : runs) {
    Kinds& kinds = of_variant[{run.recording, run.variant}];
    kinds.repetitions.insert(run.repetition);
    kinds.replicates.insert(run.replicate);
    if (!run.imu.empty()) kinds.imus.insert(run.imu);
  }
  const std::vector<std::string> windows = window_labels(runs);
  std::vector<std::string> texts = differing_edits(runs);
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> uses;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunTraits& run = runs[i];
    const Kinds& kinds = of_variant.at({run.recording, run.variant});
    if (run.frames > 0) append(texts[i], windows[i]);
    if (kinds.repetitions.size() > 1) append(texts[i], fmt::format("repetition {}", run.repetition));
    if (kinds.replicates.size() > 1) append(texts[i], fmt::format("replicate {}", run.replicate));
    if (!run.imu.empty() && kinds.imus.size() > 1) append(texts[i], imu_words(run.imu));
    ++uses[{run.recording, run.variant, texts[i]}];
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (uses.at({runs[i].recording, runs[i].variant, texts[i]}) < 2) continue;
    append(texts[i], fmt::format("({})", runs[i].folder));
  }
  return texts;
}

std::vector<std::string> run_labels(std::span<const RunTraits> runs) {
  std::vector<std::string> labels = distinctions(runs);
  for (std::size_t i = 0; i < runs.size(); ++i)
    labels[i] = labels[i].empty() ? runs[i].variant : fmt::format("{} {}", runs[i].variant, labels[i]);
  return labels;
}

}  // namespace fusebench::run_files
