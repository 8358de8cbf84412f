#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "eval/cli/console/console.hpp"
#include "eval/cli/shell/manual_page.hpp"
#include "eval/cli/shell/shell_verbs.hpp"
#include "eval/record/build_info.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::shell {

namespace {

Result<void> write_pages(const std::filesystem::path& folder, const VerbDescription& verb,
                         const VerbDescription& program) {
  const std::string page = manual_page(verb, program, record::build_info().version);
  if (auto written = text::write_text_file(folder / (manual_name(verb) + ".1"), page); !written)
    return written;
  for (const VerbDescription& inner : verb.verbs) {
    if (auto written = write_pages(folder, inner, program); !written) return written;
  }
  return {};
}

}  // namespace

console::Verb add_manual_verb(CLI::App& app) {
  auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* verb =
      app.add_subcommand("manual", "Writes the manual pages of the program and of every verb into a folder");
  verb->group("");
  verb->add_option("DIR", *folder, "Where fusebench.1, fusebench-run.1 and so on go")->required();
  return {verb, [folder, &app]() -> Result<int> {
            const VerbDescription program = describe_verbs(app);
            if (auto written = write_pages(*folder, program, program); !written)
              return tl::unexpected(written.error());
            return 0;
          }};
}

}  // namespace fusebench::cli::shell
