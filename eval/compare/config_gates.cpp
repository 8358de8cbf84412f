// Gates of the configurations of two runs: changed defaults, and options that are ignored on purpose.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/config/toml_document.hpp"
#include "eval/compare/comparison.hpp"
#include "eval/record/record.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::compare {

namespace {

/// Options that nobody set, by their keys.
std::map<std::string, std::string> defaults_of(const record::RunRecord& record) {
  std::map<std::string, std::string> defaults;
  for (const record::RecordedOption& option : record.config) {
    if (!run_files::is_edit(option.origin)) defaults[option.key] = config::to_toml(option.value);
  }
  return defaults;
}

/// Options that only one of two versions has; of many their number.
std::string differing_options_text(const std::vector<std::string>& differences) {
  constexpr std::size_t kMostNamed = 8;
  if (differences.size() <= kMostNamed) return fmt::format("options: {}", fmt::join(differences, ", "));
  return fmt::format("options: {}, and {} more that only one of the two versions has",
                     fmt::join(std::span(differences).first(kMostNamed), ", "),
                     differences.size() - kMostNamed);
}

std::map<std::string, std::string> ignored_options_of(const record::RunRecord& record,
                                                      const IgnoredOptions& ignored) {
  std::map<std::string, std::string> options;
  for (const record::RecordedOption& option : record.config)
    if (is_ignored(ignored, option.key)) options[option.key] = config::to_toml(option.value);
  return options;
}

/// Which of the ignored options differ.
void add_ignored_options(const record::RunRecord& base, const record::RunRecord& fresh,
                         const IgnoredOptions& ignored, std::vector<GateResult>& results) {
  const auto before = ignored_options_of(base, ignored);
  std::vector<std::string> differences;
  for (const auto& [key, value] : ignored_options_of(fresh, ignored)) {
    const auto there = before.find(key);
    if (there != before.end() && there->second != value)
      differences.push_back(fmt::format("{} = {} and {}", key, there->second, value));
  }
  if (!differences.empty())
    results.push_back(note("options", fmt::format("ignored: {}", fmt::join(differences, ", "))));
}

void add_changed_defaults(const record::RunRecord& base, const record::RunRecord& fresh, const Gates& gates,
                          const IgnoredOptions& ignored, std::vector<GateResult>& results) {
  auto before = defaults_of(base);
  auto after = defaults_of(fresh);
  for (auto* const options : {&before, &after})
    std::erase_if(*options, [&](const auto& option) { return is_ignored(ignored, option.first); });
  // A run that never began, or that was made elsewhere, has no configuration to compare.
  if (before.empty() || after.empty()) return;
  std::vector<std::string> changed;
  std::vector<std::string> others;
  for (const auto& [key, value] : before) {
    const auto now = after.find(key);
    if (now == after.end()) {
      others.push_back(fmt::format("{} is gone", key));
    } else if (now->second != value) {
      changed.push_back(fmt::format("{}: {} -> {}", key, value, now->second));
    }
  }
  for (const auto& [key, value] : after) {
    if (!before.contains(key)) others.push_back(fmt::format("{} = {} is new", key, value));
  }
  if (!others.empty()) results.push_back(note("config", differing_options_text(others)));
  if (changed.empty()) {
    if (others.empty()) results.push_back({"config", GateVerdict::unchanged, false, {}});
    return;
  }
  const std::string text =
      fmt::format("a default changed: {}; if it was meant, {}", fmt::join(changed, ", "), kUpdate);
  results.push_back(gates.changed_defaults_fail ? regression("config", text) : note("config", text));
}

}  // namespace

std::vector<GateResult> config_gates(const record::RunRecord& base, const record::RunRecord& fresh,
                                     const Gates& gates, const IgnoredOptions& ignored) {
  std::vector<GateResult> results;
  add_ignored_options(base, fresh, ignored, results);
  add_changed_defaults(base, fresh, gates, ignored, results);
  return results;
}

}  // namespace fusebench::compare
