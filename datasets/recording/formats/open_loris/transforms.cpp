#include "datasets/recording/formats/open_loris/transforms.hpp"

#include <fmt/format.h>

#include <span>
#include <string>

#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/reading/sensor_yaml.hpp"

namespace fusebench::formats::open_loris {

Result<calibration::FrameTree> read_transforms(const std::filesystem::path& file) {
  constexpr std::size_t kMostTransforms = 1000;
  const auto yaml = reading::SensorYaml::read(file);
  if (!yaml) return tl::unexpected(yaml.error());
  calibration::FrameTree tree;
  for (std::size_t k = 0; k < kMostTransforms; ++k) {
    const std::string item = fmt::format("trans_matrix.{}.", k);
    if (!yaml->has(item + "matrix.data")) break;
    const auto parent = yaml->text(item + "parent_frame");
    if (!parent) return tl::unexpected(parent.error());
    const auto child = yaml->text(item + "child_frame");
    if (!child) return tl::unexpected(child.error());
    const auto rows = yaml->numbers(item + "matrix.data", 16);
    if (!rows) return tl::unexpected(rows.error());
    const auto T_parent_child = calibration::rigid_transform(std::span(*rows).first<16>());
    if (!T_parent_child) {
      return yaml->fail_at(item + "matrix.data", fmt::format("the matrix is no rigid transform ({})",
                                                             calibration::kRigidTransformRule));
    }
    if (T_parent_child->translation.cwiseAbs().maxCoeff() > calibration::kMostLeverArm_m) {
      return yaml->fail_at(
          item + "matrix.data",
          fmt::format("the matrix has a translation of {:g} m (allowed up to {} m)",
                      T_parent_child->translation.cwiseAbs().maxCoeff(), calibration::kMostLeverArm_m));
    }
    tree.add(*parent, *child, *T_parent_child);
  }
  return tree;
}

}  // namespace fusebench::formats::open_loris
