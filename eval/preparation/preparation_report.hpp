// A preparation for people, and for programs.
#pragma once

#include <optional>
#include <string>

#include "datasets/recording/recording.hpp"
#include "eval/preparation/imu_check.hpp"
#include "eval/preparation/preparation.hpp"

namespace fusebench::preparation {

/// imu: nothing if the recording has no inertial samples.
[[nodiscard]] std::string to_text(const Preparation& preparation, const std::optional<ImuCheck>& imu,
                                  const recording::Recording& recording);
[[nodiscard]] std::string to_json(const Preparation& preparation, const std::optional<ImuCheck>& imu,
                                  const recording::Recording& recording);

}  // namespace fusebench::preparation
