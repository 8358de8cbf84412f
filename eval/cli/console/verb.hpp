// A verb of the command line: it adds its options to the application and says what to do when it was chosen:
// an exit code, or an error that main() prints.
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
};

}  // namespace fusebench::cli::console
