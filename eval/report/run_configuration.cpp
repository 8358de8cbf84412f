#include "eval/report/run_configuration.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

namespace fusebench::report {

namespace {

std::string value_text(const config::OptionValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

}  // namespace

page::PageDetails configuration_of(const run_files::FoundRun& run, const std::string& label) {
  const record::RunRecord& r = run.record;
  page::PageDetails details{fmt::format("{}: configuration {} and provenance", label, r.config_hash), {}};
  details.table.header = {"key", "value", "from"};
  const record::RecordedProvenance& p = r.provenance;
  const bool imported = r.timing.stages_ms.empty() && !r.program;  // it ran elsewhere, and was evaluated here
  const auto add = [&](const char* key, std::string value) {
    details.table.rows.push_back({{key, std::move(value), imported ? "the import" : "the run"}, ""});
  };
  add("version", p.version);
  add("git", p.git);
  add("compiler", p.compiler);
  add("flags", p.flags);
  add("cpu", p.cpu);
  add("threads", fmt::format("{}", p.threads));
  add("recording's fingerprint", r.recording.fingerprint);
  if (!imported) {
    add("peak memory", fmt::format("{:.0f} MB", static_cast<double>(r.timing.peak_rss_bytes) / 1e6));
    add("wall and CPU time", fmt::format("{:.1f} s, {:.1f} s", r.timing.wall_s, r.timing.cpu_s));
  }
  if (r.program) {
    add("program's version", r.program->version);
    add("program's seed", fmt::format("{}", r.program->seed));
    add("program's definition", r.program->definition);
  }
  for (const record::RecordedOption& option : r.config)
    details.table.rows.push_back({{option.key, value_text(option.value), option.origin}, ""});
  for (std::string note : r.recording.notes) {
    std::erase(note, '`');  // of Markdown
    details.table.rows.push_back({{"note on the recording", std::move(note), "the reader"}, ""});
  }
  return details;
}

}  // namespace fusebench::report
