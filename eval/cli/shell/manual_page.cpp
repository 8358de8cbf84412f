#include "eval/cli/shell/manual_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace fusebench::cli::shell {

namespace {

/// Text as it is to be read, whatever signs of roff are in it: a line that begins with one of its control
/// characters gets an empty sign before it, and a minus stays one that can be copied.
std::string roff(std::string_view text) {
  std::string escaped;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) escaped += "\\&";
    begins = c == '\n';
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// Lines that man fills would run together: each of several keeps its own.
std::string paragraphs(std::string_view text) {
  std::string lines = roff(text);
  for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 5)
    lines.replace(at, 1, "\n.br\n");
  return lines + "\n";
}

std::string item(const OptionDescription& option) {
  std::string name = option.name;
  for (std::size_t at = 0; (at = name.find(',', at)) != std::string::npos; at += 2) name.replace(at, 1, ", ");
  const std::string value = option.value.empty() ? "" : fmt::format(" {}", roff(option.value));
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}", roff(name), value, paragraphs(option.sentence));
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// One section per heading of the help text, in its order.
std::string options_of(const VerbDescription& verb) {
  std::vector<std::string> headings;
  for (const OptionDescription& option : verb.options) {
    if (std::ranges::find(headings, option.group) == headings.end()) headings.push_back(option.group);
  }
  std::string text;
  for (const std::string& heading : headings) {
    text += fmt::format(".SH \"{}\"\n", roff(upper(heading)));
    for (const OptionDescription& option : verb.options) {
      if (option.group == heading) text += item(option);
    }
  }
  return text;
}

const VerbDescription* verb_above(const VerbDescription& verb, const VerbDescription& program) {
  const VerbDescription* above = &program;
  for (std::size_t i = 0; i + 1 < verb.path.size(); ++i)
    above =
        &*std::ranges::find(above->verbs, verb.path[i], [](const auto& inner) { return inner.path.back(); });
  return above;
}

}  // namespace

std::string manual_name(const VerbDescription& verb) {
  return verb.path.empty() ? "fusebench" : fmt::format("fusebench-{}", fmt::join(verb.path, "-"));
}

std::string manual_page(const VerbDescription& verb, const VerbDescription& program,
                        std::string_view version) {
  const std::string name = manual_name(verb);
  const std::string first_line = verb.sentence.substr(0, verb.sentence.find('\n'));
  std::string text = fmt::format(
      ".\\\" Written by `fusebench manual`.\n.TH \"{}\" \"1\" \"\" \"fusebench {}\" \"FuseBench\"\n.ad l\n",
      roff(name), version);
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(first_line));
  text += fmt::format(".SH SYNOPSIS\n\\fB{}\\fR\n", roff(verb.usage));
  text += fmt::format(".SH DESCRIPTION\n{}", paragraphs(verb.sentence));
  if (!verb.places.empty()) text += ".SH ARGUMENTS\n";
  for (const OptionDescription& place : verb.places) text += item(place);
  text += options_of(verb);
  if (!verb.verbs.empty()) text += ".SH VERBS\n";
  for (const VerbDescription& inner : verb.verbs)
    text += fmt::format(".TP\n\\fB{}\\fR(1)\n{}", roff(manual_name(inner)), paragraphs(inner.sentence));
  // Exit codes are the same for all verbs and part of the program's page.
  const std::string& footer = verb.footer.empty() ? program.footer : verb.footer;
  if (!footer.empty()) text += fmt::format(".SH NOTES\n{}", paragraphs(footer));
  if (!verb.path.empty())
    text += fmt::format(".SH \"SEE ALSO\"\n\\fB{}\\fR(1)\n", roff(manual_name(*verb_above(verb, program))));
  return text;
}

}  // namespace fusebench::cli::shell
