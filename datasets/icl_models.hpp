// Where a reconstruction of ICL-NUIM's living room lies in the published model (living-room.ply).
//
// The transforms are those of SurfReg, the tool with which the data set's authors register reconstructions
// (github.com/mp3guy/SurfReg, src/SurfReg.cpp). They map the renderer's camera frame of the first frame (y
// up, left-handed) into the model (right-handed), so their determinant is -1. They are a start for a
// registration, not a truth: for kt0 and kt2 they differ from the rendered first pose by 4 cm and 2 cm.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "core/geometry.hpp"

namespace fusebench {

struct LivingRoomAlignment {
  std::string_view trajectory;  ///< "kt0" to "kt3"
  Eigen::Matrix4d T_model_icl;  ///< as published; a reflection
};

[[nodiscard]] std::span<const LivingRoomAlignment> living_room_alignments();

/// T_model_camera for a reconstruction in the axes of this project (x right, y down, z forward) whose world
/// is the first camera: T_model_icl * diag(1, -1, 1), a proper rigid transform (made orthonormal).
[[nodiscard]] SE3 model_from_first_camera(const LivingRoomAlignment& alignment);

}  // namespace fusebench
