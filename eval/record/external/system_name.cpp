#include "eval/record/external/system_name.hpp"

#include <algorithm>
#include <cctype>

#include "core/config/variants.hpp"

namespace fusebench::external {

NameFault fault_of_system_name(const std::string& name) {
  const bool allowed = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == '+';
  });
  if (!allowed || name.starts_with('.')) return NameFault::characters;
  return config::find_variant(name) ? NameFault::is_variant : NameFault::none;
}

}  // namespace fusebench::external
