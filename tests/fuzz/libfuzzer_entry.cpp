// Hands libFuzzer's inputs to the target that the build names in FUSEBENCH_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fusebench::fuzz::FUSEBENCH_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
