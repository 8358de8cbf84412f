#include "core/estimator/measurement/patch_squares.hpp"

#include <cmath>
#include <optional>

#include "core/base/bits.hpp"

namespace fusebench::measurement {

namespace {

/// Positions of the visible pixels of a square and their mean motion.
struct VisiblePlaces {
  std::vector<std::optional<Vector2d>> at_px;  ///< index: pixel of the square
  Vector2d mean_motion_px = Vector2d::Zero();
};

VisiblePlaces visible_places(const SeenPatch& seen, int side_px, const Eigen::Vector2i& corner_px,
                             int reference_width_px) {
  VisiblePlaces places;
  places.at_px.resize(seen.patch.square_grey.size());
  const auto& pixels = seen.patch.levels.front().pixels;
  int count = 0;
  for (std::size_t group = 0; group < seen.warped.size(); ++group) {
    const patches::WarpedLanes& w = seen.warped[group];
    for_each_bit(simd::lane_bits(w.visible), [&](std::size_t lane) {
      const auto key = static_cast<int>(pixels[group * simd::kLanes + lane].reference_pixel);
      const Eigen::Vector2i place(key % reference_width_px, key / reference_width_px);
      const Eigen::Vector2i in_square = place - corner_px;
      const Vector2d warped(static_cast<double>(w.x[lane]), static_cast<double>(w.y[lane]));
      places.at_px[static_cast<std::size_t>(in_square.y() * side_px + in_square.x())] = warped;
      places.mean_motion_px += warped - place.cast<double>();
      ++count;
    });
  }
  if (count > 0) places.mean_motion_px /= count;
  return places;
}

}  // namespace

void add_square(const SeenPatch& seen, const GreyImage& image, int reference_width_px,
                std::vector<SquarePixel>& pixels) {
  const auto side_px = static_cast<int>(std::lround(std::sqrt(seen.patch.square_grey.size())));
  const Eigen::Vector2i corner_px = seen.patch.centre_px.array() - side_px / 2;
  const VisiblePlaces places = visible_places(seen, side_px, corner_px, reference_width_px);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) {
      const auto i = static_cast<std::size_t>(y * side_px + x);
      const Vector2d moved = (corner_px + Eigen::Vector2i(x, y)).cast<double>() + places.mean_motion_px;
      const Vector2d at = places.at_px[i].value_or(moved);
      if (!(at.x() >= 0 && at.y() >= 0 && at.x() <= image.width - 1 && at.y() <= image.height - 1)) continue;
      const auto reference = static_cast<double>(seen.patch.square_grey[i]);
      const auto whole = static_cast<double>(
          image(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))));
      const double interpolated = sample_bilinear(image, at.x(), at.y()).value;
      pixels.push_back({seen.number, seen.accepted, places.at_px[i].has_value(),
                        static_cast<float>(std::abs(interpolated - reference)),
                        static_cast<float>(std::abs(whole - reference))});
    }
  }
}

}  // namespace fusebench::measurement
