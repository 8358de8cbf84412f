#include "eval/child_processes.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace fusebench {

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
  const char* const name = strsignal(signal);
  return fmt::format("signal {} ({})", signal, name == nullptr ? "unknown" : name);
}

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& command) {
  check(!command.empty(), "a command has a program");
  File output(std::tmpfile());
  File errors(std::tmpfile());
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
  if (waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  process_ = -1;
  return end_of(status);
}

void ChildProcess::interrupt() const { kill(process_, SIGINT); }

ChildEnd ChildProcess::end_of(int status) {
  ChildEnd end;
  if (WIFEXITED(status)) {
    end.exit_code = WEXITSTATUS(status);
  } else {
    end.signal = WTERMSIG(status);
  }
  end.output = content(output_.get());
  end.errors = content(errors_.get());
  return end;
}

}  // namespace fusebench
