#include "datasets/calibration/frame_tree.hpp"

#include <functional>
#include <map>
#include <utility>

namespace fusebench::calibration {

void FrameTree::add(std::string parent, std::string child, const SE3& T_parent_child) {
  edges_.push_back({std::move(parent), std::move(child), T_parent_child});
}

std::optional<SE3> FrameTree::transform(std::string_view to, std::string_view from) const {
  std::map<std::string, SE3, std::less<>> T_to;  // of the frames that are reached so far
  T_to.emplace(to, SE3{});
  for (bool grows = true; grows && !T_to.contains(from);) {
    grows = false;
    for (const Edge& edge : edges_) {
      const auto parent = T_to.find(edge.parent);
      const auto child = T_to.find(edge.child);
      if (parent != T_to.end() && child == T_to.end()) {
        T_to.emplace(edge.child, parent->second * edge.T_parent_child);
        grows = true;
      } else if (parent == T_to.end() && child != T_to.end()) {
        T_to.emplace(edge.parent, child->second * edge.T_parent_child.inverse());
        grows = true;
      }
    }
  }
  const auto found = T_to.find(from);
  return found == T_to.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace fusebench::calibration
