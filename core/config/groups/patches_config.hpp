// Options: patches and their residuals.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// Where the depth and the normals of a patch's pixels come from.
enum class ReferenceSurface { model, frame, frame_ungated };
constexpr auto option_choices(ReferenceSurface) {
  return choices<ReferenceSurface>({{"model", ReferenceSurface::model},
                                    {"frame", ReferenceSurface::frame},
                                    {"frame_ungated", ReferenceSurface::frame_ungated}});
}

/// When one of two pixels that project to the same position is occluded by the other.
enum class ShrinkTest { depth_jump, any_collision };
constexpr auto option_choices(ShrinkTest) {
  return choices<ShrinkTest>(
      {{"depth_jump", ShrinkTest::depth_jump}, {"any_collision", ShrinkTest::any_collision}});
}

/// Patches: placement, size, and validity thresholds.
struct PatchConfig {
  int max_count = 100;
  int size_px = 10;
  int levels = 3;
  int fast_threshold = 7;
  int min_distance_px = 20;
  int min_valid_px = 30;
  double min_valid_fraction = 0.5;
  double max_mean_error = 30.0;
  double occlusion_distance_m = 0.1;
  ReferenceSurface reference_surface = ReferenceSurface::model;
  double anchor_share = 0.75;
  ShrinkTest shrink_test = ShrinkTest::depth_jump;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_count", self.max_count, 1, 2000, "at most this many patches a frame (Sec. 3.1: 100)");
    v.number("size_px", self.size_px, 4, 64, "side of the square patch at each level (Sec. 3.1: 10)");
    v.number("levels", self.levels, 1, 6, "pyramid levels on which each patch is tracked");
    v.number("fast_threshold", self.fast_threshold, 1, 200,
             "FAST corner threshold (grey levels; Rosten & Drummond 2006); low, because the strongest corner "
             "of each cell is used and blurred frames have only weak corners");
    v.number("min_distance_px", self.min_distance_px, 1, 500, "least distance between two patch centres");
    v.number("min_valid_px", self.min_valid_px, 1, 4096,
             "a patch with fewer usable pixels at level 0 is rejected (derived from 10x10 patches)");
    v.number("min_valid_fraction", self.min_valid_fraction, 0.0, 1.0,
             "a patch with a smaller share of usable pixels is rejected");
    v.number(
        "max_mean_error", self.max_mean_error, 1.0, 255.0,
        "a patch whose mean absolute error exceeds this is dropped after the update (grey levels, Sec. 2.3)");
    v.number("occlusion_distance_m", self.occlusion_distance_m, 0.001, 1.0,
             "a pixel is occluded or disoccluded if its predicted depth differs from the measured one by "
             "more (by twice as much while only coarse levels are used); as wide as the association gate, "
             "because a tighter gate drops every patch once the pose has drifted by it");
    v.choice("reference_surface", self.reference_surface,
             "depth and normals of a patch: from the model (Sec. 2.3), from the frame that it is cut from "
             "(Sec. 2.1.1), or from that frame with no gate on its depth");
    v.number(
        "anchor_share", self.anchor_share, 0.0, 1.0,
        "patches keep the frame that they were cut from, the anchor, whose pose is in the state. All are "
        "cut again when the correlations of the surviving patches sum to no more than this share of the "
        "number of patches; 1: in each fused frame");
    v.choice("shrink_test", self.shrink_test,
             "of two pixels that project to the same position the farther one is dropped if it is clearly "
             "farther, or always (Sec. 2.1.1 as printed)");
  }
};

}  // namespace fusebench::config
