#include "eval/cli/results/recorded_frames.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/record/record.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::cli::results {

namespace {

Result<std::filesystem::path> folder_of(const record::RecordedRecording& recorded,
                                        const std::filesystem::path& data,
                                        const std::filesystem::path& runs) {
  std::error_code ignored;
  const std::filesystem::path simulated =
      std::filesystem::weakly_canonical(runs, ignored).parent_path() / "simulated" / recorded.name;
  if (recorded.data == "simulated" && std::filesystem::is_directory(simulated, ignored)) return simulated;
  return suites::find_recording(recorded.name, data);
}

Result<std::vector<ColorImage>> read_frames(const std::filesystem::path& folder,
                                            const record::RecordedRecording& recorded,
                                            std::span<const std::size_t> frames) {
  auto recording = datasets::open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  const std::size_t end = recorded.first_frame + recorded.frames;
  if (end <= recording->frames.size()) {
    if (auto cut = recording::select_frames(*recording, recorded.first_frame, end); !cut)
      return tl::unexpected(cut.error());
  }
  if (recording->fingerprint != recorded.fingerprint) {
    return fail(ErrorCode::data_missing,
                fmt::format("{} has another content than when it was run", folder.string()));
  }
  std::vector<ColorImage> images;
  for (const std::size_t frame : frames) {
    auto loaded = recording->load_frame(frame);
    if (!loaded) return tl::unexpected(loaded.error());
    images.push_back(std::move(loaded->color));
  }
  return images;
}

}  // namespace

report::FrameReader recorded_frames(const std::filesystem::path& data, const std::filesystem::path& runs) {
  return [data, runs](const record::RecordedRecording& recording, std::span<const std::size_t> frames) {
    return folder_of(recording, data, runs).and_then([&](const std::filesystem::path& folder) {
      return read_frames(folder, recording, frames);
    });
  };
}

}  // namespace fusebench::cli::results
