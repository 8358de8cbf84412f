// In place of opencv_odometries.cpp where the module is not installed.
#include "tests/bench/peers/opencv_odometries.hpp"

namespace fusebench::peers {

std::vector<Peer> opencv_odometries() {
  return {{.name = "OpenCV rgbd odometries", .settings = "", .package = "libopencv-contrib-dev"}};
}

}  // namespace fusebench::peers
