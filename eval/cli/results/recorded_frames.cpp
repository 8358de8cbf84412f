#include "eval/cli/results/recorded_frames.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/record/record.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::cli::results {

namespace {

Result<std::vector<ColorImage>> read_frames(const std::filesystem::path& data,
                                            const record::RecordedRecording& recorded,
                                            std::span<const std::size_t> frames) {
  const auto folder = suites::find_recording(recorded.name, data);
  if (!folder) return tl::unexpected(folder.error());
  auto recording = datasets::open_recording(*folder);
  if (!recording) return tl::unexpected(recording.error());
  const std::size_t end = recorded.first_frame + recorded.frames;
  if (end <= recording->frames.size()) {
    if (auto cut = recording::select_frames(*recording, recorded.first_frame, end); !cut)
      return tl::unexpected(cut.error());
  }
  if (recording->fingerprint != recorded.fingerprint) {
    return fail(ErrorCode::data_missing,
                fmt::format("{} has another content than when it was run", folder->string()));
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

report::FrameReader recorded_frames(const std::filesystem::path& data) {
  return [data](const record::RecordedRecording& recording, std::span<const std::size_t> frames) {
    return read_frames(data, recording, frames);
  };
}

}  // namespace fusebench::cli::results
