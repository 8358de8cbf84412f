#include "eval/report/evo_results/npy_array.hpp"

#include <gtest/gtest.h>

#include <string>

namespace fusebench {

using namespace evo_results;

namespace {

std::string with_header(std::string header, const std::string& values) {
  header.append(118 - header.size() - 1, ' ');
  header += '\n';
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + values;
}

void expect_refused(const std::string& bytes, std::string_view part) {
  const auto array = parse_npy(bytes, "a.npy");
  ASSERT_FALSE(array.has_value()) << part;
  EXPECT_EQ(array.error().code, ErrorCode::data_corrupt);
  EXPECT_TRUE(array.error().message.starts_with("a.npy: ")) << array.error().message;
  EXPECT_NE(array.error().message.find(part), std::string::npos) << array.error().message;
}

TEST(NpyArray, TheBytesOfNumpy) {
  // numpy.save() of numpy.array([1.0, -2.0]).
  const std::string values("\0\0\0\0\0\0\xF0\x3F\0\0\0\0\0\0\0\xC0", 16);
  const std::string expected =
      with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", values);
  EXPECT_EQ(npy_bytes(row_of({1.0, -2.0})), expected);
  EXPECT_EQ(parse_npy(expected, "a.npy")->values, (std::vector<double>{1.0, -2.0}));
}

TEST(NpyArray, WhatIsWrittenIsReadBack) {
  for (const NpyArray& array :
       {NpyArray{{2, 3}, {1, 2, 3, 4, 5, 0.1}}, NpyArray{{0}, {}}, row_of({1e-300})}) {
    const std::string bytes = npy_bytes(array);
    EXPECT_EQ((bytes.size() - 8 * array.values.size()) % 64, 0U) << "values are aligned";
    const auto again = parse_npy(bytes, "a.npy");
    ASSERT_TRUE(again.has_value()) << again.error().message;
    EXPECT_EQ(again->shape, array.shape);
    EXPECT_EQ(again->values, array.values);
  }
}

TEST(NpyArray, SinglesAreRead) {
  const std::string single("\0\0\0\x3F", 4);
  EXPECT_EQ(
      parse_npy(with_header("{'descr': '<f4', 'fortran_order': False, 'shape': (1,), }", single), "a.npy")
          ->values,
      std::vector<double>{0.5});
}

TEST(NpyArray, AnythingElseIsRefused) {
  const std::string bytes = npy_bytes(row_of({1, 2}));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(parse_npy(bytes.substr(0, size), "a.npy").has_value()) << size;
  expect_refused(bytes + "x", "17 bytes of values");
  expect_refused("PK", "no array of NumPy");
  expect_refused(with_header("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", "12345678"),
                 "the type '|O'");
  expect_refused(with_header("{'descr': '<f8', 'fortran_order': True, 'shape': (1, 1), }", "12345678"),
                 "Fortran");
  expect_refused(with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }", "12345678"),
                 "header");
  expect_refused(with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }",
                             "12345678"),
                 "header");
}

}  // namespace
}  // namespace fusebench
