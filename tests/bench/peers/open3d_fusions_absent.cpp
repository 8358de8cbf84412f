// In place of open3d_fusions.cpp where the library is not installed.
#include "tests/bench/peers/open3d_fusions.hpp"

namespace fusebench::peers {

std::vector<Peer> open3d_fusions() {
  return {{.name = "Open3D volumes", .settings = "", .package = "libopen3d-dev", .task = Task::fusion}};
}

}  // namespace fusebench::peers
