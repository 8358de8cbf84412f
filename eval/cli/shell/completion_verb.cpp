#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "eval/cli/console/console.hpp"
#include "eval/cli/shell/completion.hpp"
#include "eval/cli/shell/shell_verbs.hpp"

namespace fusebench::cli::shell {

console::Verb add_completion_verb(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand(
      "completion",
      "Prints the script by which bash or zsh completes verbs, options and values (docs/install.md)");
  verb->add_option("SHELL", *shell, "Whose script")->required()->check(CLI::IsMember({"bash", "zsh"}));
  return {verb, [shell, &app]() -> Result<int> {
            const VerbDescription program = describe_verbs(app);
            console::print_output(*shell == "bash" ? bash_completion(program) : zsh_completion(program));
            return 0;
          }};
}

}  // namespace fusebench::cli::shell
