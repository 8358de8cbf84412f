#include "datasets/images/image_library_loader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string_view>

namespace fusebench::images {

namespace {

constexpr const char* kModule = "fusebench_images.so";
constexpr const char* kHint =
    "build or install all of fusebench: this module with OpenImageIO reads images other than plain PNGs and "
    "writes JPEGs";

/// Error message of the dynamic linker without its leading file name.
std::string reason_besides(const std::string& file) {
  const char* const said = dlerror();
  std::string_view reason = said != nullptr ? said : "no reason given";
  const std::string about_file = fmt::format("{}: ", file);
  if (reason.starts_with(about_file)) reason.remove_prefix(about_file.size());
  return std::string(reason);
}

}  // namespace

Result<const ImageLibrary*> load_image_library(const std::string& file) {
  // Lazy binding as for the program's own libraries; binding all functions of 270 libraries takes time.
  void* const module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (module == nullptr)
    return fail(ErrorCode::io, fmt::format("{} cannot be loaded: {}", file, reason_besides(file)), kHint);
  const auto entry =
      reinterpret_cast<decltype(&fusebench_image_library)>(dlsym(module, kImageLibraryFunction));
  const ImageLibrary* const library = entry != nullptr ? entry(kImageLibraryBuild) : nullptr;
  if (library == nullptr)
    return fail(ErrorCode::io, fmt::format("{} is not of this build of fusebench", file), kHint);
  return library;
}

const Result<const ImageLibrary*>& image_library() {
  static const Result<const ImageLibrary*> library = load_image_library(kModule);
  return library;
}

}  // namespace fusebench::images
