// Names of systems that are not part of this program.
#pragma once

#include <string>

namespace fusebench::external {

/// Why the name cannot be a folder and a row in tables beside the variants of this program; empty if it can.
/// Allowed: letters, digits, '-', '_', '+' and '.', not first.
enum class NameFault { none, characters, is_variant };
[[nodiscard]] NameFault fault_of_system_name(const std::string& name);

}  // namespace fusebench::external
