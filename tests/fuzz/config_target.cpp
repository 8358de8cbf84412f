// TOML files of options.
#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

void config(std::string_view bytes) {
  static const MemoryFile file("options.toml");
  file.write(bytes);
  config::EffectiveConfig effective = config::variant_config(*config::find_variant("full"));
  if (const auto applied = config::apply_config_file(effective, file.path()); !applied) {
    check_error(applied.error(), file.path());
    return;
  }
  // A configuration that was accepted is one: its values are within their ranges, and it has a hash.
  check(!config::config_hash(effective.values()).empty(), "a configuration has a hash");
}

}  // namespace fusebench::fuzz
