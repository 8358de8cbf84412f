// Loaded into the program by LD_PRELOAD: in place of its main(), serves requests to run that main() in a
// forked child. Loading and relocating fifty libraries costs 20 ms, a child 1 ms; tests/attack runs a hundred
// thousand commands.
//
// With FUSEBENCH_FORK_SERVER=DESCRIPTOR (a stream socket) in the environment, and in
// FUSEBENCH_FORK_SERVER_LOADS a module to load once, for all children (that of image formats: half a second).
// A request is, in native byte order,
//   uint32 size of what follows; then uint32 cpu_s, wall_ms, memory_mb (address space; 0: no limit), file_mb;
//   then strings, each ended by a zero byte: working folder, file for standard output, file for standard
//   error, number of settings, "NAME=VALUE" of each setting, and the arguments without the program's name.
// and its answer: int32 exit code, or minus the signal; uint32 wall_ms, cpu_ms, peak_mb; uint32 flags: 1
// killed after wall_ms, 2 left a process behind (which is killed).
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;

struct Limits {
  std::uint32_t cpu_s, wall_ms, memory_mb, file_mb;
};

struct Answer {
  std::int32_t status = 0;
  std::uint32_t wall_ms = 0, cpu_ms = 0, peak_mb = 0, flags = 0;
};

bool read_all(int descriptor, void* place, std::size_t size) {
  auto* bytes = static_cast<char*>(place);
  while (size > 0) {
    const ssize_t got = read(descriptor, bytes, size);
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

void limit(int what, std::uint64_t amount) {
  const rlimit both{amount, amount};
  setrlimit(static_cast<__rlimit_resource>(what), &both);
}

void redirect(const char* file, int descriptor) {
  const int opened = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(125);
}

/// Runs the program's main() with the request's arguments, and ends as it does.
[[noreturn]] void become_program(int socket, const Limits& limits, const std::vector<char*>& words,
                                 char* name) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  close(socket);
  if (chdir(words[0]) != 0) _exit(125);
  redirect(words[1], STDOUT_FILENO);
  redirect(words[2], STDERR_FILENO);
  const std::size_t settings = std::strtoul(words[3], nullptr, 10);
  for (std::size_t i = 0; i < settings; ++i) putenv(words[4 + i]);
  std::vector<char*> arguments{name};
  arguments.insert(arguments.end(), words.begin() + static_cast<std::ptrdiff_t>(4 + settings), words.end());
  arguments.push_back(nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_s);
  limit(RLIMIT_FSIZE, std::uint64_t{limits.file_mb} << 20U);
  if (limits.memory_mb > 0) limit(RLIMIT_AS, std::uint64_t{limits.memory_mb} << 20U);
  const int code = program_main(static_cast<int>(arguments.size()) - 1, arguments.data(), environ);
  std::fflush(nullptr);
  // Without destructors of libraries: those of the module's wait for threads that a child does not have.
  _exit(code);
}

std::uint32_t milliseconds(const timeval& time) {
  return static_cast<std::uint32_t>(time.tv_sec * 1000 + time.tv_usec / 1000);
}

Answer waited_for(pid_t child, const Limits& limits) {
  Answer answer;
  const auto begin = std::chrono::steady_clock::now();
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  pollfd ended{handle, POLLIN, 0};
  if (poll(&ended, 1, static_cast<int>(limits.wall_ms)) == 0) {
    answer.flags |= 1U;
    kill(-child, SIGKILL);
    kill(child, SIGKILL);
  }
  if (handle >= 0) close(handle);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  if (kill(-child, 0) == 0) {
    // A child that is ending beside its parent is none that is left.
    usleep(200'000);
    if (kill(-child, SIGKILL) == 0 && (answer.flags & 1U) == 0) answer.flags |= 2U;
  }
  answer.status = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  answer.cpu_ms = milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
  answer.peak_mb = static_cast<std::uint32_t>(usage.ru_maxrss / 1024);
  answer.wall_ms = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin)
          .count());
  return answer;
}

int serve(int, char** argv, char**) {
  const int socket = std::atoi(std::getenv("FUSEBENCH_FORK_SERVER"));
  unsetenv("FUSEBENCH_FORK_SERVER");
  if (const char* const module = std::getenv("FUSEBENCH_FORK_SERVER_LOADS"))
    if (dlopen(module, RTLD_LAZY | RTLD_LOCAL) == nullptr) return 2;
  unsetenv("LD_PRELOAD");  // what the program starts is not served
  std::uint32_t size = 0;
  while (read_all(socket, &size, sizeof size)) {
    std::vector<char> bytes(size);
    if (!read_all(socket, bytes.data(), size)) return 1;
    Limits limits{};
    std::memcpy(&limits, bytes.data(), sizeof limits);
    std::vector<char*> words;
    for (std::size_t at = sizeof limits; at < size; at += std::strlen(&bytes[at]) + 1)
      words.push_back(&bytes[at]);
    const pid_t child = fork();
    if (child == 0) become_program(socket, limits, words, argv[0]);
    setpgid(child, child);
    const Answer answer = waited_for(child, limits);
    if (write(socket, &answer, sizeof answer) != static_cast<ssize_t>(sizeof answer)) return 1;
  }
  return 0;
}

}  // namespace

// The C library's start of a program, whose first argument is main().
extern "C" int __libc_start_main(Main given, int argc, char** argv, void (*init)(), void (*fini)(),
                                 void (*ended)(), void* stack_end) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  program_main = given;
  return start(std::getenv("FUSEBENCH_FORK_SERVER") == nullptr ? given : serve, argc, argv, init, fini, ended,
               stack_end);
}
