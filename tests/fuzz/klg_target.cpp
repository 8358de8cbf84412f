// Logs of ElasticFusion.
#include <string>

#include "core/base/error.hpp"
#include "datasets/image_logs/klg_log.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace image_logs;

namespace {

/// So small that mutations of a committed input reach every branch.
constexpr int kWidth_px = 4;
constexpr int kHeight_px = 3;

}  // namespace

void klg(std::string_view bytes) {
  static const MemoryFile file("room.klg");
  file.write(bytes);
  auto reader = KlgReader::open(file.path(), kWidth_px, kHeight_px);
  if (!reader) {
    check(reader.error().code == ErrorCode::data_corrupt, "what is read from a file can only be corrupt");
    return;
  }
  std::int32_t read = 0;
  std::string again = klg_header(static_cast<std::size_t>(reader->frame_count()));
  bool plain = true;
  while (true) {
    const auto frame = reader->next();
    if (!frame) {
      check(frame.error().code == ErrorCode::data_corrupt, "damage of a frame is an error of its own");
      return;
    }
    if (!*frame) break;
    ++read;
    check((*frame)->depth_mm.width == kWidth_px && (*frame)->depth_mm.height == kHeight_px,
          "depth has the size that was asked for");
    check((*frame)->color.data.empty() || (*frame)->jpeg.empty(), "colour is plain or a JPEG");
    plain = plain && !(*frame)->color.data.empty();
    again += klg_bytes(**frame);
  }
  check(read == reader->frame_count(), "a log has as many frames as it says");
  if (!plain) return;
  file.write(again);
  auto rewritten = KlgReader::open(file.path(), kWidth_px, kHeight_px);
  check(rewritten.has_value(), "what was read can be written and read again");
  for (std::int32_t k = 0; k < read; ++k) {
    const auto frame = rewritten->next();
    check(frame && *frame, "all of it");
  }
}

}  // namespace fusebench::fuzz
