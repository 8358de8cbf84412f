// Detects images that a camera or its driver delivered twice. A repeated image is older than its frame.
#pragma once

#include <optional>

#include "core/base/io/fingerprint.hpp"
#include "core/base/types.hpp"

namespace fusebench::core {

/// Which images of a frame are new.
struct Novelty {
  bool color = true;
  bool depth = true;

  [[nodiscard]] bool complete() const { return color && depth; }
};

class RepeatedImages {
 public:
  /// Compares grey and depth with the last examined frame. A constant image (no light, no depth) never counts
  /// as a repetition.
  [[nodiscard]] Novelty examine(const RgbdFrame& frame);

 private:
  std::optional<io::ContentHash> color_;
  std::optional<io::ContentHash> depth_;
};

}  // namespace fusebench::core
