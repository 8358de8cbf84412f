// The scanner of text tables: fields, times and numbers, against properties and the C library.
#include "core/base/io/text_table.hpp"

#include <cmath>
#include <cstdlib>

#include "core/base/trajectory/trajectory_file.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/properties.hpp"
#include "tests/fuzz/targets.hpp"

namespace fusebench::fuzz {

using namespace io;
using namespace trajectory;

namespace {

void check_fields(std::string_view line, const std::vector<std::string_view>& fields) {
  std::size_t length = 0;
  for (const std::string_view field : fields) {
    const bool quoted = field.data() > line.data() && *(field.data() - 1) == '"';
    check(quoted || field.find_first_of(", \t\r\v\f") == field.npos, "no separator is left in a field");
    check(field.data() >= line.data() && field.data() + field.size() <= line.data() + line.size(),
          "a field lies within its line");
    length += field.size();
  }
  check(length + (fields.empty() ? 0 : fields.size() - 1) <= line.size(), "separators take a character each");
}

void check_time(std::string_view text, TimeUnit unit) {
  const auto time_ns = parse_time_ns(text, unit);
  if (!time_ns) return check(!time_ns.error().message.empty(), "an error says what is wrong");
  const auto again = parse_time_ns(stamp_text(*time_ns));
  check(again && *again == *time_ns, "a stamp reads back as the same time");
  const double scale = std::pow(10.0, static_cast<int>(unit));
  const double approximately = std::strtod(std::string(text).c_str(), nullptr) * scale;
  check(std::abs(static_cast<double>(*time_ns) - approximately) <= 1.0 + 1e-12 * std::abs(approximately),
        "a time is the number that the C library reads");
}

void check_number(std::string_view text) {
  const auto value = parse_number(text);
  if (!value) return check(!value.error().message.empty(), "an error says what is wrong");
  check(std::isfinite(*value), "a number is finite");
  const std::string copy(text);
  char* end = nullptr;
  check(std::strtod(copy.c_str(), &end) == *value && *end == '\0',
        "a number is the one that the C library reads");
}

void check_table(std::string_view bytes) {
  static const MemoryFile file("table.txt");
  file.write(bytes);
  auto table = TextTable::open(file.path(), "timestamp a b");
  check(table.has_value(), "a file that is there is opened");
  int line = 0;
  for (auto row = table->next();; row = table->next()) {
    if (!row) return check_error(row.error(), file.path());
    if (!*row) return;
    check(table->line() > line, "lines are counted upwards");
    line = table->line();
    for (std::size_t column = 0; column < 3; ++column) {
      if (const auto value = table->number(column); !value) check_error(value.error(), file.path());
    }
    if (const auto time_ns = table->time_ns(0); !time_ns) check_error(time_ns.error(), file.path());
  }
}

}  // namespace

void text_table(std::string_view bytes) {
  std::vector<std::string_view> fields;
  split_fields(bytes, fields);
  check_fields(bytes, fields);
  for (const std::string_view field : fields) {
    for (const auto unit :
         {TimeUnit::seconds, TimeUnit::milliseconds, TimeUnit::microseconds, TimeUnit::nanoseconds}) {
      check_time(field, unit);
    }
    check_number(field);
  }
  check_table(bytes);
}

}  // namespace fusebench::fuzz
