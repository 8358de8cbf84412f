// Images that a camera or its driver delivered twice: a repeated image is of an earlier instant than its
// frame.
#pragma once

#include <optional>

#include "core/base/types.hpp"
#include "core/io/fingerprint.hpp"

namespace fusebench::core {

/// What of a frame was not in the frame before.
struct Novelty {
  bool color = true;
  bool depth = true;

  [[nodiscard]] bool complete() const { return color && depth; }
};

class RepeatedImages {
 public:
  /// Compares the content of grey and depth with that of the last frame that was examined. An image of one
  /// value (no light, no depth) shows no instant and is never a repetition.
  [[nodiscard]] Novelty examine(const RgbdFrame& frame);

 private:
  std::optional<io::ContentHash> color_;
  std::optional<io::ContentHash> depth_;
};

}  // namespace fusebench::core
