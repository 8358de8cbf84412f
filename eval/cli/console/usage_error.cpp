#include "eval/cli/console/usage_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <optional>
#include <regex>
#include <string_view>

#include "core/base/nearest_name.hpp"
#include "core/base/printable.hpp"

namespace fusebench::cli::console {

namespace {

/// "fusebench eval ate": a verb with those above it.
std::string full_name(const CLI::App& app) {
  const CLI::App* const parent = app.get_parent();
  return parent == nullptr ? app.get_name() : full_name(*parent) + " " + app.get_name();
}

std::vector<const CLI::App*> shown_verbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

const CLI::App* verb_named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (verb->get_name() == name) return verb;
  }
  return nullptr;
}

/// "--variant", "-r", of all options of a verb.
std::vector<std::string> flags_of(const CLI::App& verb) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return flags;
}

bool is_flag(const std::string& argument) {
  const bool number = argument.size() > 1 &&
                      (std::isdigit(static_cast<unsigned char>(argument[1])) != 0 || argument[1] == '.');
  return argument.size() > 1 && argument[0] == '-' && argument != "--" && !number;
}

/// "--name" of "--name=value"; of flags in one, "-xvf", and of "-r5" the first.
std::string flag_name(const std::string& argument) {
  if (argument.starts_with("--")) return argument.substr(0, argument.find('='));
  return argument.substr(0, 2);
}

std::string help_of(const CLI::App& verb) {
  return fmt::format("`{} --help` lists what is allowed", full_name(verb));
}

Error unknown_verb(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* verb : shown_verbs(app)) names.push_back(verb->get_name());
  if (app.get_name() == "eval")
    names.emplace_back("ape");  // evo's name of `eval ate`, which is taken as well
  const std::string place = app.get_parent() == nullptr ? "" : fmt::format(" of `{}`", full_name(app));
  return {ErrorCode::usage,
          fmt::format("unknown verb '{}'{}{}", printable(name), place, nearest_hint(name, names)),
          fmt::format("`{} --help` lists the verbs", full_name(app))};
}

Error unknown_flag(const CLI::App& verb, const std::string& argument) {
  // Of flags of one letter none is nearer than another, but a long name may have lost a '-'.
  const std::string given = argument.substr(0, argument.find('='));
  std::vector<std::string> long_flags = flags_of(verb);
  std::erase_if(long_flags, [](const std::string& flag) { return !flag.starts_with("--"); });
  std::string message = fmt::format("`{}` has no option {}", full_name(verb), printable(given));
  if (given.size() > 2 && !long_flags.empty()) message += nearest_hint(given, long_flags);
  return {ErrorCode::usage, std::move(message), help_of(verb)};
}

/// The first unsupported verb or flag; `verb` becomes the last verb in the arguments.
std::optional<Error> not_understood(const CLI::App& program, const std::vector<std::string>& arguments,
                                    const CLI::App*& verb) {
  verb = &program;
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    if (is_flag(argument)) {
      const std::vector<std::string> flags = flags_of(*verb);
      if (std::ranges::find(flags, flag_name(argument)) == flags.end()) return unknown_flag(*verb, argument);
      continue;
    }
    if (const CLI::App* const inner = verb_named(*verb, argument)) {
      verb = inner;
    } else if (!shown_verbs(*verb).empty()) {
      return unknown_verb(*verb, argument);
    }
  }
  return std::nullopt;
}

/// The parser's message in the terms of the command line.
std::string reworded(const CLI::App& verb, const std::string& complaint) {
  std::smatch part;
  if (std::regex_match(complaint, part, std::regex("(.+): At Most (\\d+) required but received (\\d+)")))
    return fmt::format("{} takes {} at most, {} are given", part[1].str(), part[2].str(), part[3].str());
  if (std::regex_match(complaint, part, std::regex("(.+): At least (\\d+) required but received (\\d+)")))
    return fmt::format("{} takes {} at least, {} given", part[1].str(), part[2].str(), part[3].str());
  if (std::regex_match(complaint, part, std::regex("(.+): (\\d+) required (.*) ?missing")))
    return part[2].str() == "1" ? fmt::format("{} is given without its value", part[1].str())
                                : fmt::format("{} takes {} values", part[1].str(), part[2].str());
  if (std::regex_match(complaint, part, std::regex("Could not convert: (.+) = (.*)")))
    return fmt::format("{} {}: not a value of this option", part[1].str(), printable(part[2].str()));
  if (complaint == "A subcommand is required")
    return fmt::format("`{}` is given without a verb", full_name(verb));
  if (std::regex_match(complaint, part, std::regex("(.+): (.*) not in \\{(.+)\\}"))) {
    const std::vector<std::string> allowed = CLI::detail::split(part[3].str(), ',');
    return fmt::format("{} {}: not one of {}{}", part[1].str(), printable(part[2].str()),
                       fmt::join(allowed, ", "), nearest_hint(part[2].str(), allowed));
  }
  if (complaint.starts_with("The following argument"))
    return fmt::format("`{}` does not take {}", full_name(verb),
                       printable(fmt::format("{}", fmt::join(verb.remaining(), " ")), 200));
  return complaint;
}

}  // namespace

std::optional<Error> unknown_words(const CLI::App& program, const std::vector<std::string>& arguments) {
  const CLI::App* verb = &program;
  return not_understood(program, arguments, verb);
}

Error usage_error(const CLI::App& program, const std::vector<std::string>& arguments,
                  const CLI::ParseError& complaint) {
  const CLI::App* verb = &program;
  if (auto error = not_understood(program, arguments, verb)) return *error;
  return {ErrorCode::usage, reworded(*verb, complaint.what()), help_of(*verb)};
}

}  // namespace fusebench::cli::console
