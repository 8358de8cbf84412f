#include "eval/record/data_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fusebench::record {

namespace {

constexpr std::array<DataLabel, 3> kLabels = {
    {{"synthetic IMU",
      "made from the ground truth with sensor noise, since the recording has no gyroscope. Such rows compare "
      "variants; they are no evidence of accuracy without ground truth.",
      &DataWords::imu},
     {"simulated",
      "images, IMU and ground truth were made by `fusebench simulate`; such rows say nothing about real "
      "sensors beyond what the simulation models.",
      &DataWords::data},
     {kPseudoTruthWord,
      "the reference is a batch estimate of the same recording (`fusebench smooth`), not independent of what "
      "is compared with it. Errors of such rows are distances from that estimate; they are no evidence of "
      "accuracy.",
      &DataWords::truth}}};

}  // namespace

DataWords words_of(const RecordedRecording& recording) {
  return {recording.data, recording.imu, recording.truth};
}

std::string DataLabel::footnote() const { return fmt::format("{}: {}", mark, sentence); }

std::span<const DataLabel> data_labels() { return kLabels; }

std::string data_cell(const DataWords& words) {
  return words.truth == kPseudoTruthWord ? fmt::format("{}, {}", words.data, words.truth)
                                         : std::string(words.data);
}

std::vector<std::string> data_footnotes(std::span<const DataWords> runs) {
  std::vector<std::string> footnotes;
  for (const DataLabel& label : kLabels) {
    const auto applies = [&](const DataWords& words) { return label.applies(words); };
    if (std::any_of(runs.begin(), runs.end(), applies)) footnotes.push_back(label.footnote());
  }
  return footnotes;
}

}  // namespace fusebench::record
