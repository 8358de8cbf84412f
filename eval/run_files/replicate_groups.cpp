#include "eval/run_files/replicate_groups.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace fusebench::run_files {

namespace {

/// All that was asked for but the replicate.
auto request_of(const record::RunRecord& record) {
  const record::RecordedRecording& recording = record.recording;
  return std::tuple(recording.name, recording.fingerprint, recording.first_frame, recording.frames,
                    recording.imu, record.variant, record.config_hash, record.repetition);
}

}  // namespace

std::vector<std::vector<std::size_t>> replicate_groups(std::span<const FoundRun> runs) {
  std::vector<std::vector<std::size_t>> groups;
  // The same replicate twice is another run, as of an imported trajectory: it begins a group of its own.
  std::map<decltype(request_of(runs.front().record)), std::map<int, std::size_t>> open;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    auto& members = open[request_of(runs[i].record)];
    if (members.contains(runs[i].record.replicate)) members.clear();
    if (members.empty()) groups.emplace_back();
    members.emplace(runs[i].record.replicate, members.empty() ? groups.size() - 1 : members.begin()->second);
    groups[members.begin()->second].push_back(i);
  }
  for (auto& group : groups)
    std::ranges::stable_sort(group, {}, [&](std::size_t i) { return runs[i].record.replicate; });
  return groups;
}

}  // namespace fusebench::run_files
