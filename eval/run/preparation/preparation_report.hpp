// A preparation for people, and for programs.
#pragma once

#include <string>

#include "datasets/recording/recording.hpp"
#include "eval/run/preparation/preparation.hpp"
#include "eval/run/preparation/sensor_check.hpp"

namespace fusebench::preparation {

[[nodiscard]] std::string to_text(const Preparation& preparation, const SensorCheck& sensors,
                                  const recording::Recording& recording);
[[nodiscard]] std::string to_json(const Preparation& preparation, const SensorCheck& sensors,
                                  const recording::Recording& recording);

}  // namespace fusebench::preparation
