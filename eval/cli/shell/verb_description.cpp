#include "eval/cli/shell/verb_description.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "eval/cli/trajectories/evo_spelling.hpp"

namespace fusebench::cli::shell {

namespace {

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// "recorded", "auto" of "TEXT:{recorded,auto}"; empty if the type has no such list.
std::vector<std::string> listed_words(const std::string& type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

/// Words that the parser does not check, because the verb has a better error message.
std::vector<std::string> known_words(const std::vector<std::string>& flags) {
  std::vector<std::string> words;
  if (std::ranges::find(flags, "--variant") != flags.end()) {
    for (const config::Variant& variant : config::all_variants()) words.emplace_back(variant.name);
  } else if (std::ranges::find(flags, "--set") != flags.end()) {
    for (const config::OptionRow& row : config::describe_options(config::EffectiveConfig{}.values()))
      words.push_back(row.key + "=");
  }
  return words;
}

ValueKind kind_of(const CLI::Option& option, const OptionDescription& description) {
  if (option.get_items_expected_max() == 0) return ValueKind::none;
  if (!description.words.empty()) return ValueKind::words;
  const std::string type = option.get_type_name();
  if (contains(type, "FILE")) return ValueKind::file;
  if (contains(type, "DIR") || contains(type, "FOLDER")) return ValueKind::folder;
  // What goes by its place is nearly always a file or a folder.
  return description.flags.empty() ? ValueKind::file : ValueKind::text;
}

std::string without_leading_blanks(std::string text) {
  text.erase(0, text.find_first_not_of(" \n"));
  return text;
}

OptionDescription describe(const CLI::Option& option, bool by_place) {
  const CLI::Formatter formatter;
  OptionDescription description;
  if (!by_place) {
    for (const std::string& name : option.get_snames()) description.flags.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) description.flags.push_back("--" + name);
  }
  description.name = formatter.make_option_name(&option, by_place);
  description.value = without_leading_blanks(formatter.make_option_opts(&option));
  description.sentence = option.get_description();
  description.group = option.get_group();
  description.words = listed_words(option.get_type_name());
  if (description.words.empty()) description.words = known_words(description.flags);
  description.kind = kind_of(option, description);
  description.repeats = option.get_items_expected_max() > 1;
  return description;
}

VerbDescription describe(const CLI::App& app, std::vector<std::string> path, const std::string& name) {
  VerbDescription verb{std::move(path), {}, app.get_description(), {}, app.get_footer(), {}, {}, {}};
  if (verb.path.size() == 2 && verb.path[0] == "eval")
    verb.other_name = trajectories::name_in_evo(verb.path[1]);
  const CLI::Formatter formatter;
  const std::string usage =
      formatter.make_usage(&app, name);  // "Usage: fusebench ...", with line breaks around
  verb.usage = without_leading_blanks(usage.substr(usage.find(':') + 1));
  verb.usage.erase(verb.usage.find_last_not_of(" \n") + 1);
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) verb.places.push_back(describe(*option, true));
    if (option->nonpositional()) verb.options.push_back(describe(*option, false));
  }
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (inner->get_group().empty()) continue;
    std::vector<std::string> inner_path = verb.path;
    inner_path.push_back(inner->get_name());
    verb.verbs.push_back(describe(*inner, std::move(inner_path), name + " " + inner->get_name()));
  }
  return verb;
}

}  // namespace

VerbDescription describe_verbs(const CLI::App& program) { return describe(program, {}, program.get_name()); }

}  // namespace fusebench::cli::shell
