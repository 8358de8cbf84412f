// Archives of results, and the arrays in them.
#include <cstddef>

#include "eval/report/evo_results/npy_array.hpp"
#include "eval/report/evo_results/zip_archive.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace evo_results;

namespace {

void check_array(const std::string& bytes) {
  const auto array = parse_npy(bytes, "array.npy");
  if (!array) {
    check_error(array.error(), "array.npy");
    return;
  }
  std::size_t elements = 1;
  for (const std::size_t size : array->shape) elements *= size;
  check(elements == array->values.size(), "an array has as many values as its shape says");
}

void check_round_trip(const MemoryFile& file, const std::vector<ZipEntry>& entries) {
  const auto bytes = zip_bytes(entries);
  check(bytes.has_value(), "what was read can be written");
  file.write(*bytes);
  const auto again = read_zip(file.path());
  check(again && again->size() == entries.size(), "what is written reads back");
  for (std::size_t i = 0; i < entries.size(); ++i)
    check((*again)[i].name == entries[i].name && (*again)[i].bytes == entries[i].bytes,
          "files are as they were");
}

}  // namespace

void zip_archive(std::string_view bytes) {
  static const MemoryFile file("result.zip");
  check_array(std::string(bytes));
  file.write(bytes);
  const auto entries = read_zip(file.path());
  if (!entries) {
    check_error(entries.error(), file.path());
    return;
  }
  for (const ZipEntry& entry : *entries) check_array(entry.bytes);
  check_round_trip(file, *entries);
}

}  // namespace fusebench::fuzz
