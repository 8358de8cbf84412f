// Light of a row of pixels as a sum of samples.
#pragma once

#include <Eigen/Core>
#include <span>

#include "datasets/simulator/rays/ray_field.hpp"
#include "datasets/simulator/render/lit_scene.hpp"
#include "datasets/simulator/render/renderer.hpp"

namespace fusebench::simulator::render {

/// Implements Renderer::add_light_of_row(). A ray is first tested against the triangle of a nearby hit; the
/// others are traced.
void add_light_of_samples(const LitScene& scene, const rays::RayField& field,
                          std::span<const RowSample> samples, std::span<Eigen::Array4f> light);

}  // namespace fusebench::simulator::render
