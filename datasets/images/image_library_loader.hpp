// Loads the module of the image library.
#pragma once

#include <string>

#include "core/base/error.hpp"
#include "datasets/images/image_library.hpp"

namespace fusebench::images {

/// Loads the image library from a module, which stays loaded. file: a name is searched in the folders of the
/// program's run path and of the system; a path is used as given. Errors: io (no such file, a missing
/// dependency, or another build).
[[nodiscard]] Result<const ImageLibrary*> load_image_library(const std::string& file);

/// The image library of this build. Loaded by the first call (thread-safe); later calls return the same
/// result. Errors as above.
[[nodiscard]] const Result<const ImageLibrary*>& image_library();

}  // namespace fusebench::images
