#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/suites/engine/run_housekeeping.hpp"
#include "eval/text/json_text.hpp"

namespace fusebench::cli::running {

namespace {

struct GcOptions {
  std::filesystem::path runs;
  engine::Garbage garbage;
  bool json = false;
};

Result<int> collect(const GcOptions& options) {
  const auto report = engine::collect_garbage(options.runs, options.garbage);
  if (!report) return tl::unexpected(report.error());
  std::vector<std::string> paths;
  for (const std::filesystem::path& path : report->paths) paths.push_back(path.string());
  if (options.json) {
    console::print_output(text::json_text({{"temporaries", report->temporaries},
                                           {"runs", report->runs},
                                           {"bytes", report->bytes},
                                           {"paths", paths},
                                           {"removed", !options.garbage.only_look}}) +
                          "\n");
  } else {
    for (const std::string& path : paths) {
      if (options.garbage.only_look) console::print_output(path + "\n");
    }
    console::print_output(fmt::format("{}{} left by killed processes, {} runs of {:.1f} MB\n",
                                      options.garbage.only_look ? "would remove " : "removed ",
                                      report->temporaries, report->runs,
                                      static_cast<double>(report->bytes) / 1e6));
  }
  return 0;
}

struct MergeOptions {
  std::vector<std::filesystem::path> from;
  std::filesystem::path into;
};

Result<int> merge(const MergeOptions& options) {
  std::size_t differing = 0;
  for (const std::filesystem::path& from : options.from) {
    const auto report = engine::merge_runs(from, options.into);
    if (!report) return tl::unexpected(report.error());
    differing += report->differing;
    console::print_progress(fmt::format(
        "{}: {} runs copied, {} were there{}{}", from.string(), report->copied, report->there,
        report->damaged == 0 ? "" : fmt::format(", {} are damaged and were left out", report->damaged),
        report->damaged_invocations == 0
            ? ""
            : fmt::format(", {} of the suites that `rerun` runs again are damaged and were left out",
                          report->damaged_invocations)));
  }
  if (differing == 0) return 0;
  return fail(ErrorCode::data_corrupt,
              fmt::format("{} runs of one identity ended differently in the two folders", differing),
              "the same binary and data give the same results: is one of the machines faulty?");
}

}  // namespace

console::Verb add_gc_verb(CLI::App& app) {
  auto options = std::make_shared<GcOptions>();
  CLI::App* verb = app.add_subcommand("gc",
                                      "Removes temporary files, stale claims and, with options, failed or "
                                      "outdated runs from a folder of runs");
  verb->add_option("RUNS", options->runs, "Folder of runs")->required();
  verb->add_flag("--failed", options->garbage.failed, "Failed and damaged runs, too");
  verb->add_flag("--stale", options->garbage.stale, "Runs of other versions of the estimator, too");
  verb->add_flag("--dry-run", options->garbage.only_look, "Lists the files without removing them");
  console::add_json_flag(*verb, options->json);
  return {verb, [options] { return collect(*options); }};
}

console::Verb add_merge_verb(CLI::App& app) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* verb =
      app.add_subcommand("merge", "Copies the runs of several folders (e.g. of several machines) into one");
  verb->add_option("FROM", options->from, "Folders of runs")->required();
  verb->add_option("--into", options->into, "Folder that they are copied to")->required()->type_name("DIR");
  return {verb, [options] { return merge(*options); }};
}

}  // namespace fusebench::cli::running
