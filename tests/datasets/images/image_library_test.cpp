#include "datasets/images/image_library.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "datasets/images/image_library_loader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;

namespace {

/// Why a file is refused as the image library.
std::string refusal(const std::string& file) {
  const auto library = load_image_library(file);
  if (library) return "was not refused";
  EXPECT_EQ(library.error().code, ErrorCode::io);
  EXPECT_NE(library.error().hint, "");
  return library.error().message;
}

TEST(ImageLibrary, MissingModule) {
  EXPECT_EQ(refusal("no_such_module.so"),
            "no_such_module.so cannot be loaded: cannot open shared object file: No such file or directory");
}

TEST(ImageLibrary, DamagedModule) {
  const testing::TemporaryFolder folder;
  const std::string file = folder.write("damaged.so", "this is text").string();
  EXPECT_EQ(refusal(file), file + " cannot be loaded: file too short");
}

TEST(ImageLibrary, LibraryOfSomebodyElse) {
  EXPECT_EQ(refusal("libm.so.6"), "libm.so.6 is not of this build of fusebench");
}

TEST(ImageLibrary, ModuleRejectsAnotherBuild) {
  ASSERT_TRUE(image_library());
  void* const module = dlopen("fusebench_images.so", RTLD_LAZY);
  ASSERT_NE(module, nullptr) << dlerror();
  const auto entry =
      reinterpret_cast<decltype(&fusebench_image_library)>(dlsym(module, kImageLibraryFunction));
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry(kImageLibraryBuild), *image_library());
  EXPECT_EQ(entry("images 0"), nullptr);
}

}  // namespace
}  // namespace fusebench
