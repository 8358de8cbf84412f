// Bytes within text (RFC 4648).
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fusebench::text {

[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace fusebench::text
