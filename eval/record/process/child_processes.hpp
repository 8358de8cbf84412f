// Programs that run beside this one: started, watched without waiting, and asked to stop.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/process/nameless_file.hpp"

namespace fusebench::process {

/// How a child ended, with all that it wrote.
struct ChildEnd {
  std::optional<int> exit_code;  ///< nothing if a signal ended it, or if nobody can know any more
  int signal = 0;                ///< 0: none
  std::string output;            ///< standard output
  std::string errors;            ///< standard error

  /// "exit code 3", "signal 9 (Killed)", "an unknown state".
  [[nodiscard]] std::string how() const;
};

/// One running program. It gets an interrupt (SIGINT), unless it had one, and is waited for when it is
/// destroyed.
class ChildProcess {
 public:
  /// command[0] is the program's file. What the child writes goes to files without a name, so that nothing is
  /// left of them. Error io.
  [[nodiscard]] static Result<ChildProcess> start(const std::vector<std::string>& command);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  /// Nothing while it runs; afterwards its end, once. The state is unknown if somebody else waited for it.
  [[nodiscard]] std::optional<ChildEnd> poll();
  /// Once: a second interrupt may end a program that is about to tidy up.
  void interrupt();

 private:
  ChildProcess(pid_t process, NamelessFile output, NamelessFile errors)
      : process_(process), output_(std::move(output)), errors_(std::move(errors)) {}
  [[nodiscard]] ChildEnd with_output(ChildEnd end);

  pid_t process_ = -1;  // -1: ended
  bool interrupted_ = false;
  NamelessFile output_;
  NamelessFile errors_;
};

}  // namespace fusebench::process
