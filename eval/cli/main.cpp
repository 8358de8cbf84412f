// fusebench: the command line chooses and reports; all work is done elsewhere.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/stack_size.hpp"
#include "eval/cli/console/stop_signals.hpp"
#include "eval/cli/console/usage_error.hpp"
#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/cli/recordings/recording_verbs.hpp"
#include "eval/cli/results/result_verbs.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/cli/shell/shell_verbs.hpp"
#include "eval/cli/trajectories/evo_spelling.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/record/build_info.hpp"

namespace fusebench::cli {

namespace {

bool asks_for_help(int argc, const char* const* argv) {
  return argc >= 2 && std::string_view(argv[1]) == "help";
}

/// `help eval ate` is `eval ate --help`.
std::vector<const char*> words_of(int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (!asks_for_help(argc, argv)) return words;
  words.erase(words.begin() + 1);
  words.push_back("--help");
  return words;
}

int finish(const Error& error) {
  console::print_error(error);
  return console::stop_requested() ? console::kExitInterrupted : exit_code(error.code);
}

/// "eval mesh"
std::string name_of(const CLI::App& verb) {
  const std::vector<CLI::App*> inner = verb.get_subcommands();
  return inner.empty() ? verb.get_name() : verb.get_name() + " " + name_of(*inner.front());
}

int run_verb(const std::vector<console::Verb>& verbs) {
  for (const console::Verb& verb : verbs) {
    if (!verb.app->parsed()) continue;
    const console::Progress working(name_of(*verb.app));
    std::optional<console::Heartbeat> heartbeat;
    if (!verb.forks) heartbeat.emplace();
    const auto done = verb.run();
    return done ? *done : finish(done.error());
  }
  return finish({ErrorCode::usage, "no verb is given", "`fusebench --help` lists the verbs"});
}

int command_line(int given_count, const char* const* given) {
  const std::vector<const char*> words = words_of(given_count, given);
  const int argc = static_cast<int>(words.size());
  const char* const* const argv = words.data();
  CLI::App app{
      "FuseBench: offline evaluation and benchmarking of RGB-D-inertial reconstruction\n"
      "(`fusebench help VERB` or `fusebench VERB --help`: what a verb does and takes)",
      "fusebench"};
  const record::BuildInfo& build = record::build_info();
  app.set_version_flag("--version", fmt::format("fusebench {} ({}, {}, estimator {})", build.version,
                                                build.git, build.compiler, build.estimator));
  app.footer(
      "Exit codes: 0 ok; 1 a regression or a failed gate; 2 usage or configuration; 3 data missing or "
      "corrupt;\n"
      "4 a run failed or was lost, or something cannot be written; 5 internal error; 130 interrupted.");
  const std::vector<console::Verb> verbs = {running::add_run_verb(app),
                                            running::add_bench_verb(app),
                                            running::add_reproduce_verb(app),
                                            running::add_rerun_verb(app),
                                            running::add_slurm_task_verb(app),
                                            running::add_best_verb(app),
                                            running::add_collect_verb(app),
                                            results::add_compare_verb(app),
                                            running::add_gc_verb(app),
                                            running::add_merge_verb(app),
                                            evaluation::add_eval_verb(app),
                                            results::add_table_verb(app),
                                            results::add_report_verb(app),
                                            running::add_import_verb(app),
                                            add_list_verb(app),
                                            add_config_verb(app),
                                            recordings::add_simulate_verb(app),
                                            recordings::add_inspect_verb(app),
                                            recordings::add_export_verb(app),
                                            recordings::add_convert_verb(app),
                                            recordings::add_calibrate_verb(app),
                                            recordings::add_prepare_verb(app),
                                            recordings::add_smooth_verb(app),
                                            shell::add_completion_verb(app),
                                            shell::add_manual_verb(app)};
  const auto arguments = trajectories::with_own_spelling({argv + std::min(argc, 1), argv + argc});
  if (!arguments) return finish(arguments.error());
  if (asks_for_help(given_count, given)) {
    if (const auto unknown = console::unknown_words(app, *arguments)) return finish(*unknown);
  }
  try {
    app.parse(
        std::vector<std::string>(arguments->rbegin(), arguments->rend()));  // it takes them from the end
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return finish(console::usage_error(app, *arguments, error));
  }
  return run_verb(verbs);
}

/// The exit code; nothing is thrown.
int guarded_command_line(int argc, const char* const* argv) {
  try {
    const int code = command_line(argc, argv);
    return console::output_arrived() ? code : exit_code(ErrorCode::io);
  } catch (const std::bad_alloc&) {
    const Error error{ErrorCode::run_failed, "not enough memory",
                      "close other programs, raise the limit (ulimit -v), or give less input"};
    console::print_error(error);
    return exit_code(error.code);
  } catch (const std::exception& error) {
    console::print_error({ErrorCode::internal, error.what(), "this is a bug: please report it"});
    return exit_code(ErrorCode::internal);
  }
}

}  // namespace

}  // namespace fusebench::cli

int main(int argc, char** argv) {
  using namespace fusebench::cli;
  console::prepare_standard_streams();
  console::handle_stop_signals();
  return console::call_with_enough_stack([&] { return guarded_command_line(argc, argv); });
}
