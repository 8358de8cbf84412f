// What the libraries that are loaded into the program by LD_PRELOAD share.
#pragma once

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>

namespace fusebench::preloaded {

/// The function that ours stands before.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// The absolute path of an open file or folder; of one without a name it ends in " (deleted)".
template <std::size_t kSize>
const char* path_of(int descriptor, char (&path)[kSize]) {
  char link[40];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const long size = syscall(SYS_readlinkat, AT_FDCWD, link, path, kSize - 1);
  path[size > 0 ? size : 0] = '\0';
  return path;
}

}  // namespace fusebench::preloaded
