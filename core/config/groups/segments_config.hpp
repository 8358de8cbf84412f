// Options: stretches that are tracked apart from the map while the camera is lost.
#pragma once

namespace fusebench::config {

/// When a segment begins, and how often the map is looked for in it.
struct SegmentsConfig {
  double begin_after_s = 0.5;
  int search_every = 5;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("begin_after_s", self.begin_after_s, 0.0, 1e6,
             "a camera that has been lost for so long (seconds), and sees nothing that is in the map, is tracked in "
             "a segment of its own, which is joined to the map when a place of it is recognised; 0: never. Needs "
             "terms.relocalisation");
    v.number("search_every", self.search_every, 1, 1000,
             "the map is looked for in every so many frames of a segment: a search takes as long as tracking a "
             "frame");
  }
};

}  // namespace fusebench::config
