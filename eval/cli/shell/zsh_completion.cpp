#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "eval/cli/shell/completion.hpp"

namespace fusebench::cli::shell {

namespace {

/// For the inside of single quotes, in a description that ends at ':' or ']'.
std::string described(std::string_view sentence) {
  std::string text;
  for (const char c : sentence.substr(0, sentence.find('\n'))) {
    if (c == '\'') {
      text += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') text += '\\';
      text += c;
    }
  }
  return text;
}

std::string action_of(const OptionDescription& option) {
  switch (option.kind) {
    case ValueKind::words: {
      // No blank after "key=": the value follows. Only such lists are made of beginnings alone.
      const bool beginnings = option.words.front().ends_with('=');
      if (beginnings) return fmt::format("{{compadd -S \"\" -- {}}}", fmt::join(option.words, " "));
      return fmt::format("({})", fmt::join(option.words, " "));
    }
    case ValueKind::file:
      return "_files";
    case ValueKind::folder:
      return "_files -/";
    case ValueKind::text:
    case ValueKind::none:
      break;
  }
  return "";
}

/// What follows a flag: ":message:action". Which other options it needs or excludes is no part of a value.
std::string value_of(const OptionDescription& option) {
  if (option.kind == ValueKind::none) return "";
  const std::size_t end = std::min(option.value.find(" Needs:"), option.value.find(" Excludes:"));
  const std::string message = option.kind == ValueKind::words ? "value" : option.value.substr(0, end);
  return fmt::format(":{}:{}", described(message), action_of(option));
}

/// One line of _arguments per spelling; one that was given excludes the others, unless it may be repeated.
std::string option_lines(const OptionDescription& option) {
  std::string text;
  for (const std::string& flag : option.flags) {
    const std::string others = option.repeats ? "*" : fmt::format("({})", fmt::join(option.flags, " "));
    const std::string_view joint = option.kind == ValueKind::none ? "" : flag.starts_with("--") ? "=" : "+";
    text += fmt::format("    '{}{}{}[{}]{}' \\\n", others, flag, joint, described(option.sentence),
                        value_of(option));
  }
  return text;
}

std::string place_line(const OptionDescription& place, std::size_t number) {
  const std::string where = place.repeats ? "*" : std::to_string(number + 1);
  return fmt::format("    '{}:{}:{}' \\\n", where, described(place.name), action_of(place));
}

std::string function_name(const VerbDescription& verb) {
  std::string name = "_fusebench";
  for (const std::string& word : verb.path) name += "__" + word;
  return name;
}

void add_verb_function(std::string& text, const VerbDescription& verb) {
  text += fmt::format("{}() {{\n", function_name(verb));
  if (!verb.verbs.empty()) text += "  local curcontext=\"$curcontext\" state line\n";
  text += fmt::format("  _arguments {}-s -S \\\n", verb.verbs.empty() ? "" : "-C ");
  for (const OptionDescription& option : verb.options) text += option_lines(option);
  if (verb.verbs.empty()) {
    for (std::size_t i = 0; i < verb.places.size(); ++i) text += place_line(verb.places[i], i);
    text += "    && return 0\n}\n\n";
    return;
  }
  text += "    '1: :->verb' '*:: :->rest' && return 0\n  case $state in\n    verb)\n      local -a verbs=(\n";
  for (const VerbDescription& inner : verb.verbs) {
    text += fmt::format("        '{}:{}'\n", inner.path.back(), described(inner.sentence));
    if (!inner.other_name.empty())
      text += fmt::format("        '{}:The same as {}'\n", inner.other_name, inner.path.back());
  }
  if (verb.path.empty()) text += "        'help:What a verb does and takes'\n";
  text += "      )\n      _describe verb verbs ;;\n    rest)\n      case $line[1] in\n";
  for (const VerbDescription& inner : verb.verbs) {
    const std::string other = inner.other_name.empty() ? "" : "|" + inner.other_name;
    text += fmt::format("        {}{}) {} ;;\n", inner.path.back(), other, function_name(inner));
  }
  // What can follow is what can follow the program.
  if (verb.path.empty()) text += "        help) _fusebench ;;\n";
  text += "      esac ;;\n  esac\n}\n\n";
  for (const VerbDescription& inner : verb.verbs) add_verb_function(text, inner);
}

}  // namespace

std::string zsh_completion(const VerbDescription& program) {
  std::string text =
      "#compdef fusebench\n# zsh completion of fusebench, written by `fusebench completion zsh`\n\n";
  add_verb_function(text, program);
  // Where zsh loads this file as the function _fusebench, the first call of it is this one; where it is
  // sourced, it is declared.
  return text +
         "if [[ $funcstack[1] == _fusebench ]]; then _fusebench \"$@\"; else compdef _fusebench fusebench; "
         "fi\n";
}

}  // namespace fusebench::cli::shell
