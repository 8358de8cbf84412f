#include "eval/record/process/nameless_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace fusebench::process {

NamelessFile nameless_file() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "fusebench-XXXXXX").string();
  const int descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  unlink(name.c_str());
  std::FILE* const file = fdopen(descriptor, "w+b");
  if (file == nullptr) close(descriptor);
  return NamelessFile(file);
}

}  // namespace fusebench::process
