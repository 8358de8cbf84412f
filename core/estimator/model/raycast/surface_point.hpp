// The surface at one pixel.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::raycast {

struct SurfacePoint {
  bool valid = false;
  double depth_m = 0;                        ///< z-depth in the camera frame
  Vector3d normal_world = Vector3d::Zero();  ///< unit, towards free space (gradient of the field)
};

}  // namespace fusebench::raycast
