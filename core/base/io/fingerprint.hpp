// Content identity: 128-bit XXH3 as 32 hexadecimal digits. Not cryptographic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace fusebench::io {

/// Length and 64-bit XXH3 of some bytes: detects a changed file.
struct ContentHash {
  std::uint64_t bytes = 0;
  std::uint64_t xxh3 = 0;
  friend bool operator==(const ContentHash&, const ContentHash&) = default;
};
[[nodiscard]] ContentHash content_hash(std::string_view bytes);

/// Incremental hash over texts, numbers and files; the order of calls matters.
class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();
  Fingerprint(Fingerprint&&) noexcept;
  Fingerprint& operator=(Fingerprint&&) noexcept;

  void add(std::string_view bytes);
  /// The hash of the file alone, of the same bytes. Errors: data_missing, data_corrupt (a read error).
  [[nodiscard]] Result<ContentHash> add_file(const std::filesystem::path& file);
  [[nodiscard]] std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::io
