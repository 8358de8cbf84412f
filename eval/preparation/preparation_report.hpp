// A preparation for people, and for programs.
#pragma once

#include <string>

#include "datasets/recording/recording.hpp"
#include "eval/preparation/preparation.hpp"

namespace fusebench::preparation {

[[nodiscard]] std::string to_text(const Preparation& preparation, const recording::Recording& recording);
[[nodiscard]] std::string to_json(const Preparation& preparation, const recording::Recording& recording);

}  // namespace fusebench::preparation
