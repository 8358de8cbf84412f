// A temporary file without a name: nothing is left of it, however this process ends.
#pragma once

#include <cstdio>
#include <memory>

namespace fusebench::process {

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};
using NamelessFile = std::unique_ptr<std::FILE, CloseFile>;

/// For reading and writing, in the folder for temporary files; programs that this process starts do not
/// inherit it. Null, with errno, if there is none to be had.
[[nodiscard]] NamelessFile nameless_file();

}  // namespace fusebench::process
