// JSON documents against a JSON Schema, as far as docs/record.schema.json uses it: type, const, enum,
// properties, required, additionalProperties, items, minItems, maxItems, minimum, oneOf and references into
// $defs. Any other word is an error.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace fusebench::testing {

class JsonSchema {
 public:
  using Json = nlohmann::json;

  explicit JsonSchema(Json schema) : root_(std::move(schema)) {}

  /// What is wrong with a document, with the place; empty if nothing is.
  [[nodiscard]] std::vector<std::string> violations(const Json& document) {
    std::vector<std::string> found;
    check(root_, "#", document, "", found);
    return found;
  }

  /// Properties, by their place in the schema, that no document so far had.
  [[nodiscard]] std::vector<std::string> unused_properties() const {
    std::vector<std::string> unused;
    collect_unused(root_, "#", unused);
    return unused;
  }

 private:
  static bool is_of(const Json& value, const std::string& type) {
    if (type == "null") return value.is_null();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    return type == "array" ? value.is_array() : value.is_object();
  }

  static bool is_of_any(const Json& value, const Json& types) {
    if (types.is_string()) return is_of(value, types);
    return std::ranges::any_of(types, [&](const Json& type) { return is_of(value, type); });
  }

  void check(const Json& schema, const std::string& at, const Json& value, const std::string& path,
             std::vector<std::string>& found) {
    const auto wrong = [&](const std::string& what) { found.push_back(fmt::format("{}: {}", path, what)); };
    for (const auto& [word, wanted] : schema.items()) {
      if (word == "$ref") {
        const std::string target = wanted.get<std::string>();
        check(root_.at(Json::json_pointer(target.substr(1))), target, value, path, found);
      } else if (word == "type") {
        if (!is_of_any(value, wanted)) wrong(fmt::format("{} is no {}", value.dump(), wanted.dump()));
      } else if (word == "const") {
        if (value != wanted) wrong(fmt::format("{} is not {}", value.dump(), wanted.dump()));
      } else if (word == "enum") {
        if (std::ranges::find(wanted, value) == wanted.end())
          wrong(fmt::format("{} is none of {}", value.dump(), wanted.dump()));
      } else if (word == "minimum") {
        if (value.is_number() && value < wanted) wrong(fmt::format("{} is too small", value.dump()));
      } else if (word == "minItems" || word == "maxItems") {
        if (value.is_array() && (word == "minItems" ? value.size() < wanted : value.size() > wanted))
          wrong(fmt::format("{} values", value.size()));
      } else if (word == "items") {
        for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
          check(wanted, at + "/items", value[i], fmt::format("{}/{}", path, i), found);
      } else if (word == "required") {
        for (const std::string key : wanted) {
          if (value.is_object() && !value.contains(key)) wrong("lacks " + key);
        }
      } else if (word == "oneOf") {
        check_one_of(wanted, at, value, path, found);
      } else if (word == "additionalProperties") {
        check_keys(schema, at, value, path, found);
      } else if (word != "properties" && word != "$defs" && word != "$schema" && word != "title" &&
                 word != "description") {
        wrong("the schema has the unknown word " + word);
      }
    }
  }

  void check_keys(const Json& schema, const std::string& at, const Json& value, const std::string& path,
                  std::vector<std::string>& found) {
    if (!value.is_object()) return;
    const Json properties = schema.value("properties", Json::object());
    const Json& others = schema.at("additionalProperties");
    for (const auto& [key, inner] : value.items()) {
      const std::string inner_path = path + "/" + key;
      if (properties.contains(key)) {
        const std::string inner_at = fmt::format("{}/properties/{}", at, key);
        used_.insert(inner_at);
        check(properties.at(key), inner_at, inner, inner_path, found);
      } else if (others.is_object()) {
        check(others, at + "/additionalProperties", inner, inner_path, found);
      } else {
        found.push_back(inner_path + ": the schema does not know it");
      }
    }
  }

  /// The violations of the choice that fits best, so that a new key is named and not "no choice fits".
  void check_one_of(const Json& choices, const std::string& at, const Json& value, const std::string& path,
                    std::vector<std::string>& found) {
    std::vector<std::vector<std::string>> of_each;
    const std::set<std::string> used_before = used_;
    std::vector<std::set<std::string>> used_by_each;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      used_ = used_before;
      check(choices[i], fmt::format("{}/oneOf/{}", at, i), value, path, of_each.emplace_back());
      used_by_each.push_back(used_);
    }
    const auto best = std::ranges::min_element(of_each, {}, &std::vector<std::string>::size);
    used_ = used_by_each[static_cast<std::size_t>(best - of_each.begin())];
    found.insert(found.end(), best->begin(), best->end());
    if (std::ranges::count_if(of_each, &std::vector<std::string>::empty) > 1)
      found.push_back(path + ": more than one choice of the schema fits");
  }

  void collect_unused(const Json& schema, const std::string& at, std::vector<std::string>& unused) const {
    if (schema.is_array()) {
      for (std::size_t i = 0; i < schema.size(); ++i)
        collect_unused(schema[i], fmt::format("{}/{}", at, i), unused);
    }
    if (!schema.is_object()) return;
    for (const auto& [word, inner] : schema.items()) {
      const std::string inner_at = at + "/" + word;
      if (at.ends_with("/properties") && !used_.contains(inner_at)) unused.push_back(inner_at);
      collect_unused(inner, inner_at, unused);
    }
  }

  Json root_;
  std::set<std::string> used_;
};

}  // namespace fusebench::testing
