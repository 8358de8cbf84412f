// The lists of a TUM folder: images and accelerometer.
#include "datasets/recording/formats/tum/tum_lists.hpp"
#include "datasets/recording/reading/image_list.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace reading;
using namespace formats::tum;

namespace {

template <class Rows>
void check_rows(const Result<Rows>& rows, const std::filesystem::path& file) {
  if (!rows) return check_error(rows.error(), file);
  check(!rows->empty(), "a list has rows");
  for (std::size_t i = 1; i < rows->size(); ++i) {
    check((*rows)[i].timestamp_ns > (*rows)[i - 1].timestamp_ns, "time strictly increases");
  }
}

}  // namespace

// The only image beside the list is the list itself, so a row is accepted that names it.
void image_list(std::string_view bytes) {
  static const MemoryFile file("list");
  file.write(bytes);
  std::vector<std::string> warnings;
  check_rows(read_image_list(file.path(), warnings), file.path());
  check_rows(read_tum_accelerometer(file.path(), warnings), file.path());
}

}  // namespace fusebench::fuzz
