// Light of the pixels of a row, as the sum of samples.
#pragma once

#include <Eigen/Core>
#include <span>

#include "datasets/simulator/rays/ray_field.hpp"
#include "datasets/simulator/render/lit_scene.hpp"
#include "datasets/simulator/render/renderer.hpp"

namespace fusebench::simulator::render {

/// Renderer::add_light_of_row(). Rays near which other rays met a triangle are tried with that one; the rest
/// are traced.
void add_light_of_samples(const LitScene& scene, const rays::RayField& field,
                          std::span<const RowSample> samples, std::span<Eigen::Array4f> light);

}  // namespace fusebench::simulator::render
