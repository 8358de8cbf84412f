// Store of visited places with ferns on small images of colour and depth (Glocker et al. 2015).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/baselines/elasticfusion/deformation/deformation_graph.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/ferns/fern_code.hpp"

namespace fusebench::baselines::elasticfusion::deformation {

/// View of the camera at 80x60.
struct FernPlace {
  ferns::FernCode code{};
  std::int32_t time = 0;
  surfels::SurfelView view;
};

/// Uses the model where the view shows it, the frame elsewhere.
[[nodiscard]] FernPlace fern_place(const surfels::LiveFrame& live, const surfels::SurfelView& view,
                                   std::int32_t time);

/// A matched place with the relocalised pose of the camera.
struct FoundPlace {
  std::size_t place = 0;
  SE3 T_place_camera;
};

class FernPlaces {
 public:
  /// The references must outlive it.
  FernPlaces(const config::ElasticfusionConfig& config, const Workers& workers)
      : config_(config), workers_(workers) {}

  /// Stores the place if more than 0.3095 of its ferns differ from those of each stored place.
  bool offer(const FernPlace& place);

  /// The most similar place that is more than min_age frames old, if more than 0.3 of its ferns agree and
  /// both views fit by point-to-plane distance, number of matches and colour.
  [[nodiscard]] std::optional<FoundPlace> find(const FernPlace& query, std::int32_t min_age,
                                               double min_matches) const;

  [[nodiscard]] const FernPlace& operator[](std::size_t place) const { return places_[place]; }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  void deform(const DeformationGraph& graph);

 private:
  const config::ElasticfusionConfig& config_;
  const Workers& workers_;
  std::vector<FernPlace> places_;
};

}  // namespace fusebench::baselines::elasticfusion::deformation
