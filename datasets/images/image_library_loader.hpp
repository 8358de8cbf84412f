// Loads the module that is the image library.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "datasets/images/image_library.hpp"

namespace fusebench::images {

/// The image library in a module, which stays loaded. file: a name is looked for in the folders that the
/// program was linked with, then in those of the system; a path is taken as it is. Errors: io (no such file,
/// a library that it needs is missing, or it is of another build).
[[nodiscard]] Result<const ImageLibrary*> load_image_library(const std::string& file);

/// The image library of this build. The first call loads it, from any thread; the same answer ever after.
/// Errors as above.
[[nodiscard]] const Result<const ImageLibrary*>& image_library();

}  // namespace fusebench::images
