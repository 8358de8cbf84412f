// Transforms between pairs of named frames, which form a tree.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geometry.hpp"

namespace fusebench::calibration {

class FrameTree {
 public:
  void add(std::string parent, std::string child, const SE3& T_parent_child);

  [[nodiscard]] bool empty() const { return edges_.empty(); }
  /// T_to_from over any number of others; nothing if no chain of transforms joins the two.
  [[nodiscard]] std::optional<SE3> transform(std::string_view to, std::string_view from) const;

 private:
  struct Edge {
    std::string parent;
    std::string child;
    SE3 T_parent_child;
  };
  std::vector<Edge> edges_;
};

}  // namespace fusebench::calibration
