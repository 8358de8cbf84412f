#include "eval/text/markup_text.hpp"

#include "core/base/error.hpp"

namespace fusebench::text {

namespace {

std::string_view entity_of(char character) {
  switch (character) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&apos;";
    case '@':
      return "&#64;";
    default:
      check(false, "the character has an entity");
      return "";
  }
}

}  // namespace

std::string with_entities(std::string_view text, std::string_view characters) {
  std::string result;
  for (const char c : text) {
    if (characters.find(c) == std::string_view::npos) {
      result += c;
    } else {
      result += entity_of(c);
    }
  }
  return result;
}

}  // namespace fusebench::text
