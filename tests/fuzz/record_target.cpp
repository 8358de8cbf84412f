// Records of runs.
#include "eval/record/record.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

void record(std::string_view bytes) {
  const std::string name = "record.json";
  const auto read = record::parse_record(bytes, name);
  if (!read) return check_error(read.error(), name);
  const std::string written = to_json(*read);
  const auto again = record::parse_record(written, name);
  check(again.has_value(), "what is written reads back");
  check(to_json(*again) == written, "and is written the same");
}

}  // namespace fusebench::fuzz
