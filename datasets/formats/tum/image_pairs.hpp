// Colour and depth images that were listed apart become frames.
#pragma once

#include <span>
#include <string_view>

#include "core/base/error.hpp"
#include "datasets/formats/tum/tum_lists.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::tum {

/// Images of one sensor in strictly increasing time; name: the list's file, for messages.
struct ImageList {
  std::string_view name;
  std::span<const ListedImage> images;
};

/// Pairs them by TUM's rule (closest first, each image once, less than options.max_difference_s apart) and
/// gives them capture times without the jitter of their stamps (options.regular_stamps). Fills
/// recording.frames; images without a partner are counted in a warning, the jitter in a note. Error
/// data_corrupt: no pair at all.
[[nodiscard]] Result<void> pair_images(const ImageList& color, const ImageList& depth,
                                       const recording::ReadOptions& options,
                                       recording::Recording& recording);

}  // namespace fusebench::formats::tum
