#include <fmt/format.h>
#include <fmt/ranges.h>

#include "eval/cli/shell/completion.hpp"

namespace fusebench::cli::shell {

namespace {

/// Words for the inside of single quotes; none of ours has one, but a shell must not see it if it had.
std::string quoted(const std::vector<std::string>& words) {
  std::string text = "'";
  for (const std::string& word : words) {
    if (text.size() > 1) text += ' ';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return text + "'";
}

std::string proposal(const OptionDescription& option) {
  switch (option.kind) {
    case ValueKind::words:
      return "words=" + quoted(option.words);
    case ValueKind::file:
      return "kind=file";
    case ValueKind::folder:
      return "kind=folder";
    case ValueKind::text:
    case ValueKind::none:
      break;
  }
  return "kind=text";
}

/// All names of a verb, each followed by an option or a place if there is one, as a pattern of `case`.
std::string pattern(const VerbDescription& verb, const std::string& what = "") {
  const std::string end = what.empty() ? "" : " " + what;
  const std::string name = fmt::format("'{}{}'", fmt::join(verb.path, " "), end);
  if (verb.other_name.empty()) return name;
  const std::vector<std::string> above(verb.path.begin(), verb.path.end() - 1);
  return fmt::format("{} | '{} {}{}'", name, fmt::join(above, " "), verb.other_name, end);
}

/// A line of the table for each verb: what can follow it.
void add_verbs(std::string& text, const VerbDescription& verb) {
  std::vector<std::string> verbs;
  if (verb.path.empty()) verbs.emplace_back("help");
  for (const VerbDescription& inner : verb.verbs) {
    verbs.push_back(inner.path.back());
    if (!inner.other_name.empty()) verbs.push_back(inner.other_name);
  }
  std::vector<std::string> flags;
  for (const OptionDescription& option : verb.options)
    flags.insert(flags.end(), option.flags.begin(), option.flags.end());
  text += fmt::format("    {}) verbs={} flags={} ;;\n", pattern(verb),
                      verb.verbs.empty() ? "''" : quoted(verbs), quoted(flags));
  for (const VerbDescription& inner : verb.verbs) add_verbs(text, inner);
}

/// A line for each option that takes a value, and for each first place that has words.
void add_values(std::string& text, const VerbDescription& verb) {
  for (const OptionDescription& option : verb.options) {
    if (option.kind == ValueKind::none) continue;
    std::vector<std::string> patterns;
    for (const std::string& flag : option.flags) patterns.push_back(pattern(verb, flag));
    text += fmt::format("    {}) {} ;;\n", fmt::join(patterns, " | "), proposal(option));
  }
  for (std::size_t i = 0; i < verb.places.size(); ++i) {
    if (verb.places[i].kind == ValueKind::words)
      text += fmt::format("    {}) {} ;;\n", pattern(verb, std::to_string(i)), proposal(verb.places[i]));
  }
  for (const VerbDescription& inner : verb.verbs) add_values(text, inner);
}

constexpr const char* kHead = R"bash(# bash completion of fusebench, written by `fusebench completion bash`
# shellcheck shell=bash

# Sets verbs and flags to what can follow a verb.
_fusebench_verb() {
  case "$1" in
)bash";

constexpr const char* kValues = R"bash(    *) verbs='' flags='' ;;
  esac
}

# Sets words, or kind (file, folder, text), to what can be the value of an option ("VERB --option") or what stands at a place
# ("VERB 0"); neither of a flag.
_fusebench_value() {
  words='' kind=''
  case "$1" in
)bash";

// COMP_WORDS has "--imu=auto" as three words.
constexpr const char* kTail = R"bash(  esac
}

_fusebench() {
  local current=${COMP_WORDS[COMP_CWORD]} before='' word verb='' option='' place=0 i
  local verbs flags words='' kind=''
  COMPREPLY=()
  _fusebench_verb ''
  for ((i = 1; i < COMP_CWORD; i++)); do
    before=${COMP_WORDS[i - 1]} word=${COMP_WORDS[i]}
    if [[ $word == '=' ]]; then
      continue
    elif [[ -n $option || $before == '=' ]]; then
      option=''
    elif [[ $word == -* ]]; then
      _fusebench_value "$verb $word"
      if [[ -n $words || -n $kind ]]; then option=$word; fi
    elif [[ " $verbs " == *" $word "* ]]; then
      if [[ $word != help ]]; then
        verb=${verb:+$verb }$word
        _fusebench_verb "$verb"
      fi
    else
      place=$((place + 1))
    fi
  done
  words='' kind=''
  before=${COMP_WORDS[COMP_CWORD - 1]}
  if [[ -n $option ]]; then
    _fusebench_value "$verb $option"
  elif [[ $current == '=' || $before == '=' ]]; then
    return
  elif [[ $current == -* ]]; then
    words=$flags
  elif [[ -n $verbs ]]; then
    words=$verbs
  else
    _fusebench_value "$verb $place"
    kind=${kind:-file}
  fi
  if [[ $current == '=' ]]; then current=''; fi
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    if [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]]; then compopt -o nospace 2>/dev/null; fi
  elif [[ $kind == file ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  elif [[ $kind == folder ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
  fi
}

complete -F _fusebench fusebench
)bash";

}  // namespace

std::string bash_completion(const VerbDescription& program) {
  std::string text = kHead;
  add_verbs(text, program);
  text += kValues;
  add_values(text, program);
  return text + kTail;
}

}  // namespace fusebench::cli::shell
