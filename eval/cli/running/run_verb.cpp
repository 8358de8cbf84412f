#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/io/abandoned.hpp"
#include "core/base/nearest_name.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/run_request.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/console/stop_signals.hpp"
#include "eval/cli/running/run_like.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/record/clock_note.hpp"
#include "eval/record/external/external_program.hpp"
#include "eval/record/external/system_name.hpp"
#include "eval/record/record_origin.hpp"
#include "eval/record/truth_contradiction.hpp"
#include "eval/run/run.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/suite_names.hpp"

namespace fusebench::cli::running {

namespace {

struct RunOptions {
  console::RunRequest request;
  std::filesystem::path system;
  std::filesystem::path like;
  int repetition = 1;
  int replicates = 1;
  std::filesystem::path out = "results/runs";
  bool profile = false;
  bool json = false;
};

/// What would do nothing is refused: a program has no options and no profile of ours.
Result<void> check_options(const RunOptions& options) {
  const auto useless = [](const std::string& option, std::string_view why) {
    return fail(ErrorCode::usage, fmt::format("{} does nothing with --system: {}", option, why));
  };
  if (options.profile) return useless("--profile", "the stages of an external program cannot be timed");
  for (const std::string& set : options.request.sets) {
    if (!set.starts_with("evaluation."))
      return useless("--set " + set, "only evaluation.* counts; its own options belong into its command");
  }
  return {};
}

/// What is no file may be the name of a shipped system, or a variant of this program.
tl::unexpected<Error> no_system_file(const std::filesystem::path& file) {
  const std::string message = fmt::format("--system {}: there is no such file", file.string());
  const std::string name = file.stem().string();
  if (external::fault_of_system_name(name) == external::NameFault::is_variant)
    return fail(ErrorCode::data_missing, message,
                fmt::format("it is a variant of this program: --variant {}", name));
  const std::filesystem::path folder = suites::shipped_configs() / "systems";
  std::vector<std::string> shipped;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".toml") shipped.push_back(entry->path().stem().string());
  }
  std::ranges::sort(shipped);
  const std::vector<std::string_view> names(shipped.begin(), shipped.end());
  const std::string nearest = nearest_name(name, names);
  if (!nearest.empty())
    return fail(ErrorCode::data_missing, message,
                fmt::format("did you mean {}?", (folder / (nearest + ".toml")).string()));
  return fail(ErrorCode::data_missing, message,
              shipped.empty()
                  ? "a system is a TOML file (docs/systems.md)"
                  : fmt::format("a system is a TOML file (docs/systems.md); in {} are those of {}",
                                folder.string(), fmt::join(shipped, ", ")));
}

/// Puts an external program in place of the variant.
Result<void> take_program(const RunOptions& options, run::RunSpec& spec) {
  if (options.system.empty()) return {};
  std::error_code ignored;
  if (!std::filesystem::exists(options.system, ignored)) return no_system_file(options.system);
  auto program = external::read_external_program(options.system);
  if (!program) return tl::unexpected(program.error());
  if (auto sensible = check_options(options); !sensible) return sensible;
  if (auto found = external::find_installed(*program); !found) return found;
  if (!program->absent.empty())
    return fail(
        ErrorCode::usage,
        fmt::format("{}: {} cannot run here: {}", options.system.string(), program->name, program->absent),
        "install it, or change `command` or `version` in that file");
  spec.variant = program->name;
  spec.program = std::make_shared<const external::ExternalProgram>(std::move(*program));
  return {};
}

Result<run::RunSpec> asked_for(const RunOptions& options) {
  if (options.request.recording.empty())
    return fail(
        ErrorCode::usage, "no recording is given",
        "RECORDING is a folder, or the name of one under --data; --like RECORD takes that of a record");
  auto spec = console::spec_of(options.request);
  if (!spec) return spec;
  spec->repetition = options.repetition;
  if (auto taken = take_program(options, *spec); !taken) return tl::unexpected(taken.error());
  return spec;
}

/// The run of a record again, with a warning where it cannot be the same.
Result<run::PreparedRun> prepare_like(const RunOptions& options) {
  const auto record = record_to_repeat(options.like);
  if (!record) return tl::unexpected(record.error());
  auto spec = spec_like(*record, options.request);
  if (!spec) return tl::unexpected(spec.error());
  spec->out = options.out;
  spec->profile = options.profile;
  auto prepared = run::prepare_run(std::move(*spec));
  if (!prepared) return prepared;
  for (const std::string& difference : differences(*record, *prepared))
    console::print_progress(fmt::format("warning: {}: results may differ", difference));
  return prepared;
}

/// Refuses options whose values are in the record. (The parser's own check lists them in varying order.)
Result<void> check_alone(const CLI::App& verb) {
  if (verb.count("--like") == 0) return {};
  for (const char* const option : {"--variant", "--imu", "--config", "--frames", "--prepare", "--repetition",
                                   "--replicates", "--system"}) {
    if (verb.count(option) > 0)
      return fail(ErrorCode::usage, fmt::format("--like and {} exclude each other", option),
                  "a record contains variant, options, IMU, frames, repetition and replicate; --set changes "
                  "an option");
  }
  return {};
}

Result<run::PreparedRun> prepare(const RunOptions& options) {
  const console::Progress opening("opening " + options.request.recording);
  if (!options.like.empty()) return prepare_like(options);
  auto spec = asked_for(options);
  if (!spec) return tl::unexpected(spec.error());
  spec->out = options.out;
  spec->profile = options.profile;
  return run::prepare_run(std::move(*spec));
}

/// Executes one run and prints its result.
Result<record::RunRecord> execute(const run::PreparedRun& prepared) {
  io::remove_abandoned(prepared.folder.parent_path());  // what an earlier one that was killed left
  const int replicate = prepared.spec.replicate;
  const std::string title = fmt::format("{} {}{}", prepared.recording.name, prepared.spec.variant,
                                        replicate > 0 ? fmt::format(" replicate {}", replicate) : "");
  console::Progress progress(title);
  const run::RunControl control = {
      .progress = [&](std::size_t frame, std::size_t total) { progress.show(frame, total); },
      .stop = &console::stop_requested(),
      .bad_data_is_recorded = false,
      .preparing =
          [&] {
            console::print_progress(fmt::format(
                "{}: measuring the timing that its calibration does not contain (--prepare off skips this)",
                prepared.recording.name));
          }};
  auto record = run::execute_run(prepared, control);
  if (!record) return record;
  // Prints the notes that opening did not print: measured timing and findings on the IMU.
  const std::vector<std::string> said = record::reading_notes(prepared.recording, prepared.spec.recording);
  for (const std::string& note : record->recording.notes) {
    // The status line has a contradiction.
    if (std::ranges::find(said, note) == said.end() && !record::is_contradiction(note))
      console::print_progress(note);
  }

  const std::string ending = record->status == record::RunStatus::ok
                                 ? console::summary_line(*record)
                                 : fmt::format("{}: {}", record::to_string(record->status), record->reason);
  console::print_progress(fmt::format("{}: {}", title, ending));
  // Where there is a truth, a dash in the table is a surprise.
  const auto& ate = record->metrics.ate;
  if (record->status == record::RunStatus::ok && !ate.value && record->recording.truth != "none") {
    console::print_progress("no ATE: " + ate.reason);
    if (!ate.hint.empty()) console::print_progress("  hint: " + ate.hint);
  }
  if (const auto note = record::clock_note(*record))
    console::print_progress(fmt::format("{}: {}", title, *note));
  return record;
}

Result<int> run(const RunOptions& options) {
  auto prepared = prepare(options);
  if (!prepared) return tl::unexpected(prepared.error());
  console::print_warnings(prepared->recording.warnings);
  if (const auto unused = run::options_without_effect(prepared->spec.config))
    console::print_progress("warning: " + *unused);
  const console::StopScope stopping(console::OnStop::end_soon);
  bool all_ok = true;
  for (int k = 0; k < options.replicates; ++k) {
    if (k > 0) {
      run::RunSpec spec = prepared->spec;
      spec.replicate = k;
      *prepared = run::place_run(std::move(spec), std::move(prepared->recording));
    }
    const auto record = execute(*prepared);
    if (!record) return tl::unexpected(record.error());
    all_ok &= record->status == record::RunStatus::ok;
    console::print_output(options.json ? record::to_json(*record) : prepared->folder.string() + "\n");
  }
  return all_ok ? 0 : console::kExitRunFailed;
}

}  // namespace

console::Verb add_run_verb(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      app.add_subcommand("run", "Runs one variant over one recording and writes the run's folder");
  console::add_run_request(*verb, options->request);
  verb->get_option("RECORDING")->required(false);  // a record names one
  options->request.prepare = "auto";
  verb->add_option("--prepare", options->request.prepare,
                   "auto: measures the timing that the calibration does not contain (`fusebench prepare`, "
                   "once per recording) and uses it; off: uses the calibration unchanged")
      ->check(CLI::IsMember({"auto", "off"}))
      ->capture_default_str();
  verb->add_option(
          "--like", options->like,
          "Repeats the run of this record.json, or of this run's folder: the same recording (by its "
          "name under --data, or RECORDING), variant, options, IMU, frames, repetition and replicate; "
          "--set changes something")
      ->type_name("RECORD");
  verb->add_option("--system", options->system,
                   "Runs the external program of this file in place of a variant (docs/systems.md)")
      ->type_name("FILE.toml")
      ->excludes("--variant");
  verb->add_option("--repetition", options->repetition,
                   "Number of the repetition: in the folder's name, and an external program's {seed}")
      ->check(CLI::Range(1, run::kMostRepetitions))
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--replicates", options->replicates,
                   "Number of runs, whose initial poses differ by noise far below the resolution of the "
                   "sensors (system.replicate_noise): their results differ by chance")
      ->check(CLI::Range(1, run::kMostReplicates))
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--out", options->out, "Results go to DIR/<recording>/<variant>/<hash8>/")
      ->type_name("DIR")
      ->capture_default_str();
  console::add_profile_flag(*verb, options->profile);
  console::add_json_flag(*verb, options->json);
  verb->footer(
      "Prints the run's folder, or with --json its record; of replicates one after the other. Exit code 4 if "
      "a run "
      "failed or was lost.");
  return {verb, [options, verb] { return check_alone(*verb).and_then([&] { return run(*options); }); }};
}

}  // namespace fusebench::cli::running
