// Loaded into the program by LD_PRELOAD: lets the n-th call that may fail do so (tests/faults).
//
// Environment: FAULTS_KIND write, sync, rename, open, create, map, fork, or allocate; FAULTS_AT n, from 1; 0
// counts only, calls of all kinds; FAULTS_ERROR an errno; FAULTS_LOG a file, which gets a line "KIND PATH"
// for each call that is counted only and "FAILED KIND PATH" for the one that failed. All calls of a process
// and its children are counted as one sequence. It is read when main() begins: in a child of the fork server
// (tests/attack), what its request says.
//
// A call counts if it changes files or takes resources: files that are opened for reading count as `open`,
// for writing as `create`. What failed once works again the next time, as after a moment of a full disk.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "tests/faults/preloaded.hpp"

namespace {

using fusebench::preloaded::path_of;
using fusebench::preloaded::real;

struct Plan {
  bool active = false;
  char kind[16] = {};
  long at = 0;
  int error = 0;
  int log = -1;
  std::atomic<long>* count = nullptr;
};

Plan plan;

/// With system calls, so that nothing here is counted.
void read_plan() {
  const char* const kind = std::getenv("FAULTS_KIND");
  const char* const at = std::getenv("FAULTS_AT");
  if (kind == nullptr || at == nullptr) return;
  std::strncpy(plan.kind, kind, sizeof plan.kind - 1);
  plan.at = std::atol(at);
  const char* const error = std::getenv("FAULTS_ERROR");
  plan.error = error != nullptr ? std::atoi(error) : EIO;
  if (const char* const log = std::getenv("FAULTS_LOG"))
    plan.log =
        static_cast<int>(syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  void* const shared = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  plan.count = new (shared) std::atomic<long>(0);
  unsetenv("LD_PRELOAD");  // programs that this one starts are not its own
}

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

/// Calls count from here on: what libraries do when they are loaded and unloaded is before and after the
/// step.
int counted_main(int argc, char** argv, char** environment) {
  read_plan();
  plan.active = plan.count != nullptr;
  const int code = program_main(argc, argv, environment);
  plan.active = false;
  return code;
}

void note(const char* prefix, const char* kind, const char* path) {
  if (plan.log < 0) return;
  char line[700];
  const int size = std::snprintf(line, sizeof line, "%s%s %.600s\n", prefix, kind, path);
  syscall(SYS_write, plan.log, line, static_cast<std::size_t>(size));
}

bool is_of_plan(const char* kind) {
  return plan.active && (plan.at == 0 || std::strcmp(kind, plan.kind) == 0);
}

/// Whether this call is the one that fails; sets errno.
bool fails(const char* kind, const char* path) {
  if (!is_of_plan(kind)) return false;
  const long number = ++*plan.count;
  const int before = errno;
  if (number != plan.at) {
    if (plan.at == 0) note("", kind, path);
    errno = before;
    return false;
  }
  note("FAILED ", kind, path);
  errno = plan.error;
  return true;
}

/// Only files: what goes to terminals and pipes is not the subject.
bool fails_on(const char* kind, int descriptor) {
  if (!is_of_plan(kind)) return false;
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))) return false;
  if (descriptor == STDOUT_FILENO || descriptor == STDERR_FILENO) return false;
  char path[600];
  return fails(kind, path_of(descriptor, path));
}

/// The program's own files, and not those of the system that libraries look into.
bool is_system_file(const char* path) {
  for (const char* const begin : {"/proc/", "/sys/", "/etc/", "/usr/", "/lib", "/dev/"})
    if (std::strncmp(path, begin, std::strlen(begin)) == 0) return true;
  return false;
}

struct Both {
  char names[600];
};

/// "FROM -> TO".
Both both(const char* from, const char* to) {
  Both text;
  std::snprintf(text.names, sizeof text.names, "%.290s -> %.290s", from, to);
  return text;
}

const char* kind_of_open(int flags) { return (flags & O_ACCMODE) == O_RDONLY ? "open" : "create"; }

bool open_fails(const char* path, int flags) {
  return !is_system_file(path) && fails(kind_of_open(flags), path);
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static auto* const next = real<ssize_t(int, const void*, size_t)>("write");
  return fails_on("write", descriptor) ? -1 : next(descriptor, bytes, size);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static auto* const next = real<ssize_t(int, const iovec*, int)>("writev");
  return fails_on("write", descriptor) ? -1 : next(descriptor, parts, count);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  static auto* const next = real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  return fails_on("write", descriptor) ? -1 : next(descriptor, bytes, size, at);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t at) {
  return pwrite64(descriptor, bytes, size, at);
}

int ftruncate64(int descriptor, off64_t size) {
  static auto* const next = real<int(int, off64_t)>("ftruncate64");
  return fails_on("write", descriptor) ? -1 : next(descriptor, size);
}

int fsync(int descriptor) {
  static auto* const next = real<int(int)>("fsync");
  return fails_on("sync", descriptor) ? -1 : next(descriptor);
}

int fdatasync(int descriptor) {
  static auto* const next = real<int(int)>("fdatasync");
  return fails_on("sync", descriptor) ? -1 : next(descriptor);
}

int syncfs(int descriptor) {
  static auto* const next = real<int(int)>("syncfs");
  return fails_on("sync", descriptor) ? -1 : next(descriptor);
}

int rename(const char* from, const char* to) {
  static auto* const next = real<int(const char*, const char*)>("rename");
  return fails("rename", both(from, to).names) ? -1 : next(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  static auto* const next = real<int(int, const char*, int, const char*, unsigned)>("renameat2");
  return fails("rename", both(from, to).names) ? -1 : next(from_folder, from, to_folder, to, flags);
}

int mkdir(const char* path, mode_t mode) {
  static auto* const next = real<int(const char*, mode_t)>("mkdir");
  return fails("create", path) ? -1 : next(path, mode);
}

int open64(const char* path, int flags, ...) {
  static auto* const next = real<int(const char*, int, mode_t)>("open64");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return open_fails(path, flags) ? -1 : next(path, flags, mode);
}

int open(const char* path, int flags, ...) {
  static auto* const next = real<int(const char*, int, mode_t)>("open");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return open_fails(path, flags) ? -1 : next(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  static auto* const next = real<int(int, const char*, int, mode_t)>("openat");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return open_fails(path, flags) ? -1 : next(folder, path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  static auto* const next = real<FILE*(const char*, const char*)>("fopen64");
  return open_fails(path, mode[0] == 'r' && std::strchr(mode, '+') == nullptr ? O_RDONLY : O_WRONLY)
             ? nullptr
             : next(path, mode);
}

FILE* fopen(const char* path, const char* mode) {
  static auto* const next = real<FILE*(const char*, const char*)>("fopen");
  return open_fails(path, mode[0] == 'r' && std::strchr(mode, '+') == nullptr ? O_RDONLY : O_WRONLY)
             ? nullptr
             : next(path, mode);
}

void* mmap64(void* place, size_t size, int protection, int flags, int descriptor, off64_t at) {
  static auto* const next = real<void*(void*, size_t, int, int, int, off64_t)>("mmap64");
  if (fails("map", descriptor >= 0 ? "of a file" : "of memory")) return MAP_FAILED;
  return next(place, size, protection, flags, descriptor, at);
}

pid_t fork() {
  static auto* const next = real<pid_t()>("fork");
  return fails("fork", "") ? -1 : next();
}

pid_t vfork() { return fork(); }

int pipe2(int* ends, int flags) {
  static auto* const next = real<int(int*, int)>("pipe2");
  return fails("open", "pipe") ? -1 : next(ends, flags);
}

// The C library's start of a program, whose first argument is main().
int __libc_start_main(Main given, int argc, char** argv, void (*init)(), void (*fini)(), void (*ended)(),
                      void* stack_end) {
  using Start = int(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program_main = given;
  return real<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, ended, stack_end);
}

}  // extern "C"

// Allocations of C++: what the program itself asks for, not what libraries do in C.
void* operator new(std::size_t size) {
  if (plan.active && fails("allocate", "")) throw std::bad_alloc();
  if (void* const place = std::malloc(size > 0 ? size : 1)) return place;
  throw std::bad_alloc();
}
void operator delete(void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t) noexcept { std::free(place); }
