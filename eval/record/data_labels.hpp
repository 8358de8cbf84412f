// What a reader must know of where a run's data come from: a mark in tables, and a sentence for each mark.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/record/record.hpp"

namespace fusebench::record {

/// The words of a record (RecordedRecording) that say it.
struct DataWords {
  std::string_view data;
  std::string_view imu;
  std::string_view truth;
};
/// Valid as long as the recording.
[[nodiscard]] DataWords words_of(const RecordedRecording& recording);

struct DataLabel {
  std::string_view mark;
  std::string_view sentence;
  std::string_view DataWords::*word = nullptr;  ///< that is the mark, where the label applies

  [[nodiscard]] bool applies(const DataWords& words) const { return words.*word == mark; }
  [[nodiscard]] std::string footnote() const;  ///< "mark: sentence"
};
[[nodiscard]] std::span<const DataLabel> data_labels();

/// "recorded", "simulated", "recorded, pseudo ground truth": a table's cell beside that of the IMU.
[[nodiscard]] std::string data_cell(const DataWords& words);

/// Of the labels that apply to any of these, in the order of data_labels().
[[nodiscard]] std::vector<std::string> data_footnotes(std::span<const DataWords> runs);

}  // namespace fusebench::record
