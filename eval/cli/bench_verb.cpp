#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "eval/batch.hpp"
#include "eval/cli/console.hpp"
#include "eval/cli/shared_options.hpp"
#include "eval/cli/verbs.hpp"
#include "eval/experiment.hpp"
#include "eval/json_text.hpp"

namespace fusebench {

namespace {

struct BenchOptions {
  std::filesystem::path suite;
  BatchOptions batch;
  bool json = false;
};

std::string json_of(const Suite& suite, const std::vector<BatchOutcome>& outcomes, std::size_t ok,
                    std::size_t total) {
  using Json = nlohmann::ordered_json;
  Json runs = Json::array();
  for (const BatchOutcome& outcome : outcomes) {
    runs.push_back({{"recording", outcome.recording},
                    {"variant", outcome.variant},
                    {"status", to_string(outcome.status)},
                    {"reason", outcome.reason},
                    {"skipped", outcome.skipped},
                    {"resumed", outcome.resumed},
                    {"folder", outcome.folder.string()}});
  }
  const Json document = {{"suite", suite.name}, {"n_ok", ok}, {"n_total", total}, {"runs", runs}};
  return json_text(document) + "\n";
}

/// The bar while a run goes on, one line when it has ended.
class BatchConsole {
 public:
  [[nodiscard]] BatchControl control() {
    BatchControl control;
    control.started = [this](const BatchJob& job, std::size_t index, std::size_t count) {
      title_ = fmt::format("[{}/{}] {} {}", index + 1, count, job.recording.filename().string(), job.variant);
      bar_ = ProgressBar(title_);
    };
    control.progress = [this](std::size_t frame, std::size_t total) { bar_.show(frame, total); };
    control.finished = [this](const BatchOutcome& outcome) {
      bar_.clear();
      const std::string ending =
          outcome.status == RunStatus::ok
              ? summary_line(outcome.record)
              : fmt::format("{}: {}", outcome.skipped ? "skipped" : to_string(outcome.status),
                            outcome.reason);
      print_progress(fmt::format("{}: {}{}", title_, outcome.resumed ? "(was there) " : "", ending));
    };
    control.stop = &stop_requested();
    return control;
  }

 private:
  std::string title_;
  ProgressBar bar_{""};
};

Result<int> bench(const BenchOptions& options) {
  const auto suite = read_suite(options.suite);
  if (!suite) return tl::unexpected(suite.error());
  BatchOptions batch = options.batch;
  if (batch.out.empty()) batch.out = std::filesystem::path("results/runs") / suite->name;
  const auto jobs = plan_batch(*suite, batch);
  if (!jobs) return tl::unexpected(jobs.error());
  BatchConsole console;
  const auto outcomes = run_batch(*jobs, batch.resume, console.control());
  if (!outcomes) return tl::unexpected(outcomes.error());

  std::size_t ok = 0;
  std::size_t total = 0;
  for (const BatchOutcome& outcome : *outcomes) {
    if (outcome.skipped) continue;
    ++total;
    if (outcome.status == RunStatus::ok) ++ok;
  }
  if (total == 0) {
    return fail(ErrorCode::data_missing,
                fmt::format("suite '{}': none of the recordings can be opened", suite->name),
                "the lines above say why");
  }
  print_progress(fmt::format("{}: {} of {} runs ok; `fusebench table {}` shows them", suite->name, ok, total,
                             batch.out.string()));
  if (options.json) print_output(json_of(*suite, *outcomes, ok, total));
  return ok == total ? 0 : kExitRunFailed;
}

}  // namespace

Verb add_bench_verb(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "Runs a suite: every variant over every recording");
  verb->add_option("SUITE", options->suite, "TOML file of a suite, e.g. configs/suites/quickstart.toml")
      ->required();
  add_data_option(*verb, options->batch.data);
  verb->add_option("--out", options->batch.out, "Folder of the runs; default: results/runs/<suite>")
      ->type_name("DIR");
  verb->add_option("--only", options->batch.only,
                   "Only some runs: recording=TEXT (the name contains it) or variant=NAME; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb->add_flag("--resume", options->batch.resume,
                 "Leaves alone what already ended as ok or lost with the same hash");
  add_set_option(*verb, options->batch.sets);
  add_threads_option(*verb, options->batch.threads);
  add_json_flag(*verb, options->json);
  verb->footer(
      "A run that fails or is lost is a row with its reason, and the suite goes on; the exit code is then "
      "4.");
  return {verb, [options] { return bench(*options); }};
}

}  // namespace fusebench
