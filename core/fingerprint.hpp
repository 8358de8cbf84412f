// Content identity: 128-bit XXH3 as 32 hexadecimal digits. Not cryptographic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace fusebench {

/// Incremental hash over texts, numbers and files; the order of calls matters.
class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();
  Fingerprint(Fingerprint&&) noexcept;
  Fingerprint& operator=(Fingerprint&&) noexcept;

  void add(std::string_view bytes);
  [[nodiscard]] Result<void> add_file(const std::filesystem::path& file);
  [[nodiscard]] std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench
