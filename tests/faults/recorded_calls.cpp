// Loaded into the program by LD_PRELOAD: records every call that changes a watched folder, in order
// (tests/faults/power_cuts.py, which reads the records).
//
// Environment: RECORD_FOLDER the watched folder, an absolute path without links; RECORD_LOG the file of the
// records, outside of it. A process and those that it forks are recorded, not programs that it starts.
//
// A call is made and recorded under one lock of all processes, so that the order of the records is the order
// of the calls. What failed is not recorded. The bytes of streams of the C library are written by calls
// inside of it, which cannot be replaced; they are recorded when the stream is closed. O_TMPFILE and writable
// mappings are not recorded: power_cuts.py compares what the records lead to with the folder that is there.
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/faults/preloaded.hpp"

namespace {

using fusebench::preloaded::path_of;
using fusebench::preloaded::real;

constexpr int kDescriptors = 1024;

struct Watch {
  int log = -1;
  std::string folder;
  pthread_mutex_t* lock = nullptr;
  std::atomic<long> written[kDescriptors] = {};  // bytes that were recorded of each descriptor
};

Watch* watch = nullptr;

/// One record: this head, two paths and the bytes.
struct Head {
  std::uint32_t size_of_bytes;
  std::uint32_t process;
  std::uint16_t size_of_path;
  std::uint16_t size_of_other;
  char kind[12];
  std::int64_t number;  // offset, size, or flags
};

/// Before main(), and with system calls, so that nothing here is recorded.
__attribute__((constructor)) void start_to_watch() {
  const char* const folder = std::getenv("RECORD_FOLDER");
  const char* const log = std::getenv("RECORD_LOG");
  if (folder == nullptr || log == nullptr) return;
  static Watch started;
  started.folder = std::string(folder) + "/";
  started.log =
      static_cast<int>(syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  void* const shared =
      mmap(nullptr, sizeof(pthread_mutex_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  started.lock = static_cast<pthread_mutex_t*>(shared);
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);  // processes may be killed
  pthread_mutex_init(started.lock, &attributes);
  watch = &started;
  unsetenv("LD_PRELOAD");
}

std::string absolute(int folder, const char* path) {
  if (path[0] == '/') return path;
  char start[4096];
  if (folder != AT_FDCWD) return std::string(path_of(folder, start)) + "/" + path;
  return syscall(SYS_getcwd, start, sizeof start) > 0 ? std::string(start) + "/" + path : path;
}

std::string path_of(int descriptor) {
  char path[4096];
  return path_of(descriptor, path);
}

bool is_watched(const std::string& path) {
  return watch != nullptr && (path + "/").compare(0, watch->folder.size(), watch->folder) == 0;
}

bool is_watched(int descriptor) { return watch != nullptr && is_watched(path_of(descriptor)); }

bool is_watched(const char* path, int flags) {
  return watch != nullptr && (flags & O_ACCMODE) != O_RDONLY && is_watched(absolute(AT_FDCWD, path));
}

/// While a call is made and recorded. Calls on pipes, which may wait for another process, are not among them.
class Turn {
 public:
  explicit Turn(bool taken) : taken_(taken && watch != nullptr) {
    if (taken_ && pthread_mutex_lock(watch->lock) == EOWNERDEAD) pthread_mutex_consistent(watch->lock);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() {
    if (taken_) pthread_mutex_unlock(watch->lock);
  }

 private:
  bool taken_;
};

/// Keeps errno: what the call said is the program's.
void record(const char* kind, const std::string& path, std::int64_t number = 0, const std::string& other = "",
            const void* bytes = nullptr, std::size_t size = 0) {
  if (!is_watched(path) && !is_watched(other)) return;
  const int before = errno;
  Head head{static_cast<std::uint32_t>(size),
            static_cast<std::uint32_t>(getpid()),
            static_cast<std::uint16_t>(path.size()),
            static_cast<std::uint16_t>(other.size()),
            {},
            number};
  std::memcpy(head.kind, kind, std::min(std::strlen(kind), sizeof head.kind));  // zeros after it
  const iovec parts[] = {{&head, sizeof head},
                         {const_cast<char*>(path.data()), path.size()},
                         {const_cast<char*>(other.data()), other.size()},
                         {const_cast<void*>(bytes), size}};
  if (syscall(SYS_writev, watch->log, parts, 4) < 0) _exit(99);  // half a record is none
  errno = before;
}

void record_write(int descriptor, const void* bytes, std::size_t size, std::int64_t at) {
  if (!is_watched(descriptor)) return;
  const int before = errno;
  if (descriptor < kDescriptors) watch->written[descriptor] += static_cast<long>(size);
  record("write", path_of(descriptor), at, "", bytes, size);
  errno = before;
}

/// What the system has copied into a file, or the C library has written: read back.
void record_content(const std::string& path, std::int64_t at, std::size_t size) {
  std::string bytes(size, '\0');
  const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path.c_str(), O_RDONLY | O_CLOEXEC, 0));
  const long got = syscall(SYS_pread64, file, bytes.data(), size, at);
  syscall(SYS_close, file);
  if (got > 0) record("write", path, at, "", bytes.data(), static_cast<std::size_t>(got));
}

void record_copy(int descriptor, std::int64_t at, ssize_t size) {
  if (size <= 0 || !is_watched(descriptor)) return;
  const int before = errno;
  record_content(path_of(descriptor), at, static_cast<std::size_t>(size));
  errno = before;
}

std::int64_t position(int descriptor) { return lseek64(descriptor, 0, SEEK_CUR); }

/// Of files that are opened for writing.
int opened(int descriptor, int folder, const char* path, int flags) {
  if (watch == nullptr || descriptor < 0 || (flags & O_ACCMODE) == O_RDONLY) return descriptor;
  const int before = errno;
  if (descriptor < kDescriptors) watch->written[descriptor] = 0;
  // Those that neither create nor truncate change nothing.
  if ((flags & (O_CREAT | O_TRUNC)) != 0)
    record("open", absolute(folder, path), (flags & O_TRUNC) != 0 ? 1 : 0);
  errno = before;
  return descriptor;
}

int flags_of(const char* mode) {
  if (mode[0] == 'r') return std::strchr(mode, '+') == nullptr ? O_RDONLY : O_RDWR;
  return O_WRONLY | O_CREAT | (mode[0] == 'w' ? O_TRUNC : 0);
}

FILE* opened(FILE* stream, const char* path, const char* mode) {
  if (stream != nullptr) opened(fileno(stream), AT_FDCWD, path, flags_of(mode));
  return stream;
}

/// A call with names that has succeeded if its result is 0.
int named(int result, const char* kind, const std::string& path, const std::string& other = "") {
  if (result == 0) record(kind, path, 0, other);
  return result;
}

int on_file(int result, const char* kind, int descriptor, std::int64_t number = 0) {
  if (result == 0 && watch != nullptr) record(kind, path_of(descriptor), number);
  return result;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  static auto* const next = real<int(const char*, int, mode_t)>("open");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  const Turn turn(is_watched(path, flags));
  return opened(next(path, flags, mode), AT_FDCWD, path, flags);
}

int open64(const char* path, int flags, ...) {
  static auto* const next = real<int(const char*, int, mode_t)>("open64");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  const Turn turn(is_watched(path, flags));
  return opened(next(path, flags, mode), AT_FDCWD, path, flags);
}

int openat(int folder, const char* path, int flags, ...) {
  static auto* const next = real<int(int, const char*, int, mode_t)>("openat");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  const Turn turn((flags & O_ACCMODE) != O_RDONLY);
  return opened(next(folder, path, flags, mode), folder, path, flags);
}

int openat64(int folder, const char* path, int flags, ...) {
  static auto* const next = real<int(int, const char*, int, mode_t)>("openat64");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  const Turn turn((flags & O_ACCMODE) != O_RDONLY);
  return opened(next(folder, path, flags, mode), folder, path, flags);
}

int creat(const char* path, mode_t mode) { return open(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }
int creat64(const char* path, mode_t mode) { return open64(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }

FILE* fopen(const char* path, const char* mode) {
  static auto* const next = real<FILE*(const char*, const char*)>("fopen");
  const Turn turn(is_watched(path, flags_of(mode)));
  return opened(next(path, mode), path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  static auto* const next = real<FILE*(const char*, const char*)>("fopen64");
  const Turn turn(is_watched(path, flags_of(mode)));
  return opened(next(path, mode), path, mode);
}

int fclose(FILE* stream) {
  static auto* const next = real<int(FILE*)>("fclose");
  const int descriptor = watch != nullptr ? fileno(stream) : -1;
  const bool writes = is_watched(descriptor) && (fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const Turn turn(writes);
  // C++ streams write with write(), and close with fclose().
  const bool is_recorded = descriptor < kDescriptors && writes && watch->written[descriptor] > 0;
  const std::string path = writes && !is_recorded ? path_of(descriptor) : "";
  const int result = next(stream);
  struct stat status {};
  if (!path.empty() && stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode))
    record_content(path, 0, static_cast<std::size_t>(status.st_size));
  return result;
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static auto* const next = real<ssize_t(int, const void*, size_t)>("write");
  const Turn turn(is_watched(descriptor));
  const ssize_t done = next(descriptor, bytes, size);
  if (done > 0) record_write(descriptor, bytes, static_cast<std::size_t>(done), position(descriptor) - done);
  return done;
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static auto* const next = real<ssize_t(int, const iovec*, int)>("writev");
  const Turn turn(is_watched(descriptor));
  const ssize_t done = next(descriptor, parts, count);
  if (done <= 0 || watch == nullptr) return done;
  std::string bytes;
  for (int i = 0; i < count; ++i) bytes.append(static_cast<const char*>(parts[i].iov_base), parts[i].iov_len);
  record_write(descriptor, bytes.data(), static_cast<std::size_t>(done), position(descriptor) - done);
  return done;
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  static auto* const next = real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  const Turn turn(is_watched(descriptor));
  const ssize_t done = next(descriptor, bytes, size, at);
  if (done > 0) record_write(descriptor, bytes, static_cast<std::size_t>(done), at);
  return done;
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t at) {
  return pwrite64(descriptor, bytes, size, at);
}

ssize_t sendfile64(int to, int from, off64_t* at, size_t size) {
  static auto* const next = real<ssize_t(int, int, off64_t*, size_t)>("sendfile64");
  const Turn turn(is_watched(to));
  const ssize_t done = next(to, from, at, size);
  record_copy(to, position(to) - done, done);
  return done;
}

ssize_t sendfile(int to, int from, off_t* at, size_t size) { return sendfile64(to, from, at, size); }

ssize_t copy_file_range(int from, off64_t* at, int to, off64_t* to_at, size_t size, unsigned flags) {
  static auto* const next = real<ssize_t(int, off64_t*, int, off64_t*, size_t, unsigned)>("copy_file_range");
  const Turn turn(is_watched(to));
  const ssize_t done = next(from, at, to, to_at, size, flags);
  record_copy(to, (to_at != nullptr ? *to_at : position(to)) - done, done);
  return done;
}

int ftruncate64(int descriptor, off64_t size) {
  static auto* const next = real<int(int, off64_t)>("ftruncate64");
  const Turn turn(is_watched(descriptor));
  return on_file(next(descriptor, size), "truncate", descriptor, size);
}

int ftruncate(int descriptor, off_t size) { return ftruncate64(descriptor, size); }

int truncate64(const char* path, off64_t size) {
  static auto* const next = real<int(const char*, off64_t)>("truncate64");
  const Turn turn(true);
  const int result = next(path, size);
  if (result == 0) record("truncate", absolute(AT_FDCWD, path), size);
  return result;
}

int truncate(const char* path, off_t size) { return truncate64(path, size); }

int fsync(int descriptor) {
  static auto* const next = real<int(int)>("fsync");
  const Turn turn(is_watched(descriptor));
  return on_file(next(descriptor), "sync", descriptor);
}

int fdatasync(int descriptor) {
  static auto* const next = real<int(int)>("fdatasync");
  const Turn turn(is_watched(descriptor));
  return on_file(next(descriptor), "sync", descriptor);
}

int syncfs(int descriptor) {
  static auto* const next = real<int(int)>("syncfs");
  const Turn turn(is_watched(descriptor));
  return on_file(next(descriptor), "syncfs", descriptor);
}

int rename(const char* from, const char* to) {
  static auto* const next = real<int(const char*, const char*)>("rename");
  const Turn turn(true);
  return named(next(from, to), "rename", absolute(AT_FDCWD, from), absolute(AT_FDCWD, to));
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  static auto* const next = real<int(int, const char*, int, const char*)>("renameat");
  const Turn turn(true);
  return named(next(from_folder, from, to_folder, to), "rename", absolute(from_folder, from),
               absolute(to_folder, to));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  static auto* const next = real<int(int, const char*, int, const char*, unsigned)>("renameat2");
  const Turn turn(true);
  const char* const kind = (flags & RENAME_EXCHANGE) != 0 ? "exchange" : "rename";
  return named(next(from_folder, from, to_folder, to, flags), kind, absolute(from_folder, from),
               absolute(to_folder, to));
}

int link(const char* from, const char* to) {
  static auto* const next = real<int(const char*, const char*)>("link");
  const Turn turn(true);
  return named(next(from, to), "link", absolute(AT_FDCWD, from), absolute(AT_FDCWD, to));
}

int symlink(const char* target, const char* path) {
  static auto* const next = real<int(const char*, const char*)>("symlink");
  const Turn turn(true);
  return named(next(target, path), "symlink", absolute(AT_FDCWD, path), target);
}

int mkdir(const char* path, mode_t mode) {
  static auto* const next = real<int(const char*, mode_t)>("mkdir");
  const Turn turn(true);
  return named(next(path, mode), "mkdir", absolute(AT_FDCWD, path));
}

int mkdirat(int folder, const char* path, mode_t mode) {
  static auto* const next = real<int(int, const char*, mode_t)>("mkdirat");
  const Turn turn(true);
  return named(next(folder, path, mode), "mkdir", absolute(folder, path));
}

int unlink(const char* path) {
  static auto* const next = real<int(const char*)>("unlink");
  const Turn turn(true);
  return named(next(path), "remove", absolute(AT_FDCWD, path));
}

int rmdir(const char* path) {
  static auto* const next = real<int(const char*)>("rmdir");
  const Turn turn(true);
  return named(next(path), "remove", absolute(AT_FDCWD, path));
}

int unlinkat(int folder, const char* path, int flags) {
  static auto* const next = real<int(int, const char*, int)>("unlinkat");
  const Turn turn(true);
  return named(next(folder, path, flags), "remove", absolute(folder, path));
}

int remove(const char* path) {
  static auto* const next = real<int(const char*)>("remove");
  const Turn turn(true);
  return named(next(path), "remove", absolute(AT_FDCWD, path));
}

}  // extern "C"
