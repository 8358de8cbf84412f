// What holds for every reader, whatever the file.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "core/base/error.hpp"

namespace fusebench::fuzz {

/// An error is about the file (its message begins with the path), is one printable line, and is not as long
/// as the file.
inline void check_error(const Error& error, const std::filesystem::path& file) {
  const auto printable = [](std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
  };
  const std::string place = file.string() + ":";
  check(error.code != ErrorCode::internal, "bad input is no internal error");
  check(error.message.starts_with(place), "an error begins with the name of the file");
  check(error.message.size() > place.size() + 1, "an error says what is wrong");
  check(printable(error.message) && printable(error.hint), "an error is one line of printable characters");
  check(error.message.size() < place.size() + 1000, "an error is short");
}

}  // namespace fusebench::fuzz
