// Colours of errors on a surface.
#pragma once

#include <span>
#include <vector>

#include "core/base/image.hpp"

namespace fusebench::mesh_error {

/// Dark blue of no error over green to yellow of `largest` and above (the colour map viridis, of matplotlib,
/// which also reads in grey and to the colour-blind); grey of what is no number. largest above 0.
[[nodiscard]] std::vector<Rgb> error_colors(std::span<const double> errors, double largest);

}  // namespace fusebench::mesh_error
