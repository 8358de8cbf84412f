// Colour and depth images that were listed apart become frames.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/association.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// Times of the images of one sensor, strictly increasing; name: where they are from, for messages.
struct ImageTimes {
  std::string_view name;
  std::span<const std::int64_t> times_ns;
};

/// Pairs them by TUM's rule (closest first, each image once, less than options.max_difference_s apart) and
/// gives them capture times without the jitter of their stamps (options.regular_stamps). Fills
/// recording.frames but for the files, a frame a pair, and returns the pairs; images without a partner are
/// counted in a warning, the jitter in a note. Error data_corrupt: no pair at all.
[[nodiscard]] Result<std::vector<trajectory::AssociatedPair>> pair_times(
    const ImageTimes& color, const ImageTimes& depth, const recording::ReadOptions& options,
    recording::Recording& recording);

/// The same for frames that a list has paired already: removes the jitter of both sensors' stamps, as
/// options.regular_stamps says. list: its name, for the notes.
void make_stamps_regular(std::string_view list, const recording::ReadOptions& options,
                         recording::Recording& recording);

/// Images of one sensor in strictly increasing time; name: the list's file, for messages.
struct ImageList {
  std::string_view name;
  std::span<const ListedImage> images;
};

/// The same with the files.
[[nodiscard]] Result<void> pair_images(const ImageList& color, const ImageList& depth,
                                       const recording::ReadOptions& options,
                                       recording::Recording& recording);

}  // namespace fusebench::reading
