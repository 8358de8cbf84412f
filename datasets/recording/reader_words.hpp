// Words of readers' warnings that are looked for elsewhere.
#pragma once

#include <string_view>

namespace fusebench::recording {

/// "12 of 240 <words> within 0.1 s".
inline constexpr std::string_view kUncoveredByTruth = "frames have no ground truth around them";

}  // namespace fusebench::recording
