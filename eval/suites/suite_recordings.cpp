#include "eval/suites/suite_recordings.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "eval/suites/recording_names.hpp"

namespace fusebench::suites {

namespace fs = std::filesystem;

namespace {

/// The names that filters choose among. absent: of recordings that do not exist.
std::vector<std::string> names_of(const PlannedRecordings& existing, std::vector<std::string> absent,
                                  const Suite& suite) {
  std::vector<std::string> names = std::move(absent);
  for (const PlannedRecording& recording : existing.present)
    names.push_back(recording.folder.filename().string());
  for (const SuiteSimulation& simulation : suite.simulations) names.push_back(simulation.name);
  return names;
}

Result<PlannedRecordings> existing_recordings(const Suite& suite, const RecordingChoice& choice) {
  PlannedRecordings planned;
  std::vector<std::string> absent;
  std::optional<Error> missing;
  if (suite.all) {
    if (choice.data.empty()) {
      return fail(ErrorCode::data_missing,
                  fmt::format("suite '{}' runs over all recordings, and no folder is given", suite.name),
                  "--data or FUSEBENCH_DATA names the folder of recordings");
    }
    const auto folders = recordings_under(choice.data);
    if (!folders) return tl::unexpected(folders.error());
    for (const fs::path& folder : *folders) {
      planned.present.push_back(
          {folder, folder.filename().string(), std::string(kHeldOutSplit), suite.variants});
    }
  }
  for (const SuiteRecording& recording : suite.recordings) {
    const auto folders = find_recordings(recording.name, choice.data);
    if (!folders) {
      absent.push_back(recording.name);
      if (!recording_may_be_wanted(choice.only, recording.name)) continue;
      if (recording.source.empty()) {
        if (!missing) missing = folders.error();
        continue;
      }
      planned.absent.push_back(fmt::format("{}: {}", recording.name, recording.source));
      continue;
    }
    for (const fs::path& folder : *folders) {
      planned.present.push_back(
          {folder, recording.group.empty() ? folder.filename().string() : recording.group, recording.split,
           recording.variants.empty() ? suite.variants : recording.variants});
    }
  }
  // A mistyped filter is reported before a missing recording.
  if (auto known = check_recordings(choice.only, suite.name, names_of(planned, std::move(absent), suite));
      !known)
    return tl::unexpected(known.error());
  if (missing) return tl::unexpected(*missing);
  return planned;
}

Result<PlannedRecording> simulated_recording(const SuiteSimulation& simulation,
                                             const RecordingChoice& choice) {
  SimulationRequest request = simulation.request;
  if (!request.trajectory.empty() && request.trajectory.is_relative()) {
    if (choice.data.empty()) {
      return fail(ErrorCode::data_missing,
                  fmt::format("{}: the trajectory {} is under --data, which is not given", simulation.place,
                              request.trajectory.string()),
                  "--data or FUSEBENCH_DATA names the folder of recordings");
    }
    request.trajectory = choice.data / request.trajectory;
  }
  return PlannedRecording{choice.simulated / simulation.name, simulation.group, simulation.split,
                          simulation.variants, std::move(request)};
}

}  // namespace

Result<PlannedRecordings> planned_recordings(const Suite& suite, const RecordingChoice& choice) {
  auto planned = existing_recordings(suite, choice);
  if (!planned) return planned;
  for (const SuiteSimulation& simulation : suite.simulations) {
    if (!recording_may_be_wanted(choice.only, simulation.name)) continue;
    auto recording = simulated_recording(simulation, choice);
    if (!recording) return tl::unexpected(recording.error());
    planned->present.push_back(std::move(*recording));
  }
  if (planned->present.empty() && !planned->absent.empty()) {
    return fail(ErrorCode::data_missing,
                fmt::format("suite '{}': none of its recordings{} is under '{}'", suite.name,
                            choice.only.empty() ? "" : " that --only keeps", choice.data.string()),
                "for example " + planned->absent.front());
  }
  // Runs go by the names of recordings: two of one name would overwrite each other's.
  std::set<std::string> names;
  for (const PlannedRecording& recording : planned->present) {
    const std::string name = recording.folder.filename().string();
    if (names.insert(name).second || suite.all) continue;
    return fail(ErrorCode::configuration,
                fmt::format("suite '{}' has two recordings of the name '{}'", suite.name, name));
  }
  return planned;
}

}  // namespace fusebench::suites
