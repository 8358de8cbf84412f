#include "core/baselines/bundlefusion/tracks.hpp"

#include "core/base/disjoint_sets.hpp"

namespace fusebench::baselines::bundlefusion {

namespace {

struct PointSum {
  Vector3d sum = Vector3d::Zero();
  double count = 0;
};

}  // namespace

Keypoints merge_tracks(std::span<const Keypoints* const> keypoints, std::span<const FramePair> pairs,
                       const Poses& T_first_camera, const PinholeCamera& camera) {
  std::vector<std::size_t> begin{0};  // first index of each frame in a numbering of all keypoints
  for (const Keypoints* const of_frame : keypoints) begin.push_back(begin.back() + of_frame->size());
  DisjointSets tracks(begin.back());  // over all keypoints
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

}  // namespace fusebench::baselines::bundlefusion
