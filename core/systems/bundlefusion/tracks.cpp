#include "core/systems/bundlefusion/tracks.hpp"

#include <algorithm>
#include <numeric>

namespace fusebench::systems::bundlefusion {

namespace {

/// Sets of keypoints, each named after its least member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t root_of(std::size_t member) {
    while (parent_[member] != member) {
      parent_[member] = parent_[parent_[member]];
      member = parent_[member];
    }
    return member;
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t root_a = root_of(a);
    const std::size_t root_b = root_of(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<std::size_t> parent_;
};

struct PointSum {
  Vector3d sum = Vector3d::Zero();
  double count = 0;
};

}  // namespace

Keypoints merge_tracks(std::span<const Keypoints* const> keypoints, std::span<const FramePair> pairs,
                       const Poses& T_first_camera, const PinholeCamera& camera) {
  std::vector<std::size_t> begin{0};  // of each frame, in a numbering of all keypoints
  for (const Keypoints* const of_frame : keypoints) begin.push_back(begin.back() + of_frame->size());
  DisjointSets tracks(begin.back());
  for (const FramePair& pair : pairs) {
    for (const KeypointMatch& match : pair.rigid.matches)
      tracks.join(begin[pair.a] + match.a, begin[pair.b] + match.b);
  }
  std::vector<PointSum> sums(begin.back());
  for (std::size_t k = 0; k < keypoints.size(); ++k) {
    if (!T_first_camera[k]) continue;
    for (std::size_t i = 0; i < keypoints[k]->size(); ++i) {
      PointSum& track = sums[tracks.root_of(begin[k] + i)];
      track.sum += *T_first_camera[k] * (*keypoints[k])[i].point_camera;
      track.count += 1;
    }
  }
  Keypoints merged;
  for (std::size_t k = 0; k < keypoints.size(); ++k) {
    for (std::size_t i = 0; i < keypoints[k]->size(); ++i) {
      const PointSum& track = sums[begin[k] + i];
      if (track.count < 2) continue;
      const Vector3d point_camera = track.sum / track.count;
      if (point_camera.z() > 0)
        merged.push_back({camera.project(point_camera), point_camera, (*keypoints[k])[i].descriptor});
    }
  }
  return merged;
}

}  // namespace fusebench::systems::bundlefusion
