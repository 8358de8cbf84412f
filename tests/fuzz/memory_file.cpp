#include "tests/fuzz/memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

#include "core/base/error.hpp"

namespace fusebench::fuzz {

namespace fs = std::filesystem;

MemoryFile::MemoryFile(const std::string& name) : descriptor_(memfd_create(name.c_str(), MFD_CLOEXEC)) {
  check(descriptor_ >= 0, "the system has memory files");
  std::string pattern = (fs::temp_directory_path() / "fusebench_fuzz_XXXXXX").string();
  check(mkdtemp(pattern.data()) != nullptr, "the temporary folder can be written to");
  folder_ = pattern;
  path_ = folder_ / name;
  also_call(name);
}

MemoryFile::~MemoryFile() {
  close(descriptor_);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void MemoryFile::also_call(const std::string& name) const {
  fs::create_directories((folder_ / name).parent_path());
  fs::create_symlink("/proc/self/fd/" + std::to_string(descriptor_), folder_ / name);
}

void MemoryFile::write(std::string_view bytes) const {
  check(ftruncate(descriptor_, 0) == 0, "a memory file can be emptied");
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t wrote =
        pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    check(wrote > 0, "a memory file can be written");
    done += static_cast<std::size_t>(wrote);
  }
}

}  // namespace fusebench::fuzz
