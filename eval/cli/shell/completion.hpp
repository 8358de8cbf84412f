// Scripts by which shells complete the program's verbs, options and values.
#pragma once

#include <string>

#include "eval/cli/shell/verb_description.hpp"

namespace fusebench::cli::shell {

/// For bash 4 and later, without the package bash-completion.
[[nodiscard]] std::string bash_completion(const VerbDescription& program);

/// For zsh: the file _fusebench of a folder of its fpath.
[[nodiscard]] std::string zsh_completion(const VerbDescription& program);

}  // namespace fusebench::cli::shell
