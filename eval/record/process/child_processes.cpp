#include "eval/record/process/child_processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace fusebench::process {

namespace {

std::string content(std::FILE* file) {
  std::string text;
  std::array<char, 1 << 14> part{};
  std::rewind(file);
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), file)) {
    text.append(part.data(), count);
  }
  return text;
}

}  // namespace

std::string ChildEnd::how() const {
  if (exit_code) return fmt::format("exit code {}", *exit_code);
  if (signal == 0) return "an unknown state";
  const char* const name = strsignal(signal);
  return fmt::format("signal {} ({})", signal, name == nullptr ? "unknown" : name);
}

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& command) {
  check(!command.empty(), "a command has a program");
  NamelessFile output = nameless_file();
  NamelessFile errors = nameless_file();
  if (!output || !errors) {
    return fail(ErrorCode::io, fmt::format("no temporary file: {}", std::strerror(errno)),
                "is there space in the folder for temporary files?");
  }
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", 0, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(output.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(errors.get()), STDERR_FILENO);
  pid_t process = -1;
  const int failed = posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0)
    return fail(ErrorCode::io, fmt::format("{} cannot be started: {}", command[0], std::strerror(failed)));
  return ChildProcess(process, std::move(output), std::move(errors));
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      interrupted_(other.interrupted_),
      output_(std::move(other.output_)),
      errors_(std::move(other.errors_)) {}

ChildProcess::~ChildProcess() {
  if (process_ < 0) return;
  interrupt();
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
}

std::optional<ChildEnd> ChildProcess::poll() {
  check(process_ >= 0, "a child that ended is not polled again");
  int status = 0;
  const pid_t ended = waitpid(process_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  process_ = -1;
  ChildEnd end;
  if (ended > 0 && WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (ended > 0 && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return with_output(std::move(end));
}

void ChildProcess::interrupt() {
  if (process_ < 0 || interrupted_) return;
  interrupted_ = true;
  kill(process_, SIGINT);
}

ChildEnd ChildProcess::with_output(ChildEnd end) {
  end.output = content(output_.get());
  end.errors = content(errors_.get());
  return end;
}

}  // namespace fusebench::process
