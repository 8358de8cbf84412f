// Words of readers that are looked for elsewhere.
#pragma once

#include <string_view>

namespace fusebench::recording {

/// "12 of 240 <words> within 0.1 s".
inline constexpr std::string_view kUncoveredByTruth = "frames have no ground truth around them";

/// How the label of a ground truth begins that was estimated from the recording itself. Files begin with it
/// behind "# ".
inline constexpr std::string_view kPseudoTruthBeginning = "pseudo ground truth";

}  // namespace fusebench::recording
