#include "eval/cli/console/shared_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

#include "eval/run/run_specification.hpp"

namespace fusebench::cli::console {

void add_data_option(CLI::App& verb, std::filesystem::path& data) {
  verb.add_option("--data", data, "Folder of recordings")->envname("FUSEBENCH_DATA")->type_name("DIR");
}

void add_threads_option(CLI::App& verb, int& threads) {
  threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  // The default is not printed: it differs between machines, and results do not depend on it.
  verb.add_option("--threads", threads,
                  "Threads of a run; default: all of the machine. Results do not depend on it")
      ->check(CLI::Range(1, run::kMostThreads))
      ->type_name("N");
}

void add_set_option(CLI::App& verb, std::vector<std::string>& sets) {
  verb.add_option("--set", sets, "Sets one option, e.g. iekf.max_iterations=8; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_config_option(CLI::App& verb, std::filesystem::path& file) {
  verb.add_option("--config", file, "TOML file of options, applied after the variant and before --set")
      ->type_name("FILE");
}

void add_variant_option(CLI::App& verb, std::string& variant) {
  verb.add_option("--variant", variant, "Variant of the estimator (`fusebench list variants`)")
      ->type_name("NAME")
      ->capture_default_str();
}

void add_profile_flag(CLI::App& verb, bool& profile) {
  verb.add_flag("--profile", profile,
                "Also writes the duration of each stage of each frame: trace.json for chrome://tracing and "
                "ui.perfetto.dev, and histograms in record.json. Results do not depend on it");
}

void add_json_flag(CLI::App& verb, bool& json) {
  verb.add_flag("--json", json, "One JSON document on standard output, nothing else there");
}

Result<config::EffectiveConfig> effective_config(const std::string& variant,
                                                 const std::filesystem::path& file,
                                                 const std::vector<std::string>& sets) {
  const auto found = config::find_variant(variant);
  if (!found) return tl::unexpected(found.error());
  config::EffectiveConfig config = config::variant_config(*found);
  if (!file.empty()) {
    if (auto applied = config::apply_config_file(config, file); !applied)
      return tl::unexpected(applied.error());
  }
  for (const std::string& assignment : sets) {
    if (auto set = config.set_assignment(assignment); !set) return tl::unexpected(set.error());
  }
  if (auto related = config::check_relations(config.values()); !related)
    return tl::unexpected(related.error());
  return config;
}

Result<std::optional<run::FrameWindow>> parse_frames(const std::string& text) {
  if (text.empty()) return std::optional<run::FrameWindow>{};
  const auto window = run::parse_window(text);
  if (!window)
    return tl::unexpected(
        Error{ErrorCode::usage, fmt::format("--{}", window.error().message), window.error().hint});
  return std::optional<run::FrameWindow>(*window);
}

}  // namespace fusebench::cli::console
