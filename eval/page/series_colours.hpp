// One colour for a variant on every page.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fusebench::page {

/// A curve of a page as it is known: a variant, or a variant with edited options.
struct ColouredName {
  std::string name;
  std::size_t rank = 0;  ///< of the variant in the order of all of them
};

/// A place in the style's colours for each name, equal for equal names. The first is left to the ground
/// truth. A variant has its own, which its rank alone tells, unless one of a smaller rank on the page has it
/// already; then, and with other options, the next free one. Colours repeat where there are more names.
[[nodiscard]] std::vector<std::size_t> series_colours(std::span<const ColouredName> names);

}  // namespace fusebench::page
