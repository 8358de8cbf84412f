// A verb of the command line: its parser, and the function that runs it, which returns an exit code or an
// error that main() prints.
#pragma once

#include <functional>

#include "core/base/error.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::console {

struct Verb {
  CLI::App* app = nullptr;
  std::function<Result<int>()> run;
  bool forks = false;  ///< runs work in forked processes, so that no Heartbeat may live around it
};

}  // namespace fusebench::cli::console
