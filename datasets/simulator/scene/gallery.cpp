#include "datasets/simulator/scene/gallery.hpp"

#include <utility>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furnishing.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"
#include "datasets/simulator/scene/scene_parts.hpp"

namespace fusebench::simulator::scene {

namespace {

using Shape = GalleryShape;

enum class Contents { books, desk, sofa };
constexpr int kContents = 3;

/// A section around x = 0, lit separately, so that light is even between sections. The first and the last one
/// have an end wall.
SimulatedScene make_section(int index, Contents contents, std::uint64_t key) {
  RoomBuilder builder;
  random::RandomSequence random(random::mix_key(key, 1));
  const RoomTextures textures = paint_room_textures(builder, random::mix_key(key, 2));
  Furnisher furnisher(builder, textures, random);
  RoomFurnishing furnishing(builder, textures, furnisher, random);
  const SE3 T_middle = placed({}, {0, 0.5 * (Shape::kFurnishedWall_m + Shape::kOppositeWall_m), 0});
  const Vector2d half_m(0.5 * Shape::kSection_m, 0.5 * (Shape::kFurnishedWall_m - Shape::kOppositeWall_m));
  const auto wall = [&](int side) { return room_wall(T_middle, half_m, Shape::kHeight_m, side); };
  furnishing.floor_and_ceiling(T_middle, half_m, Shape::kHeight_m);
  const Wall furnished = wall(2);
  if (contents == Contents::books) furnishing.books_wall(furnished);
  if (contents == Contents::desk) furnishing.desk_wall(furnished);
  if (contents == Contents::sofa) furnishing.sofa_wall(furnished);
  const Paint plaster{.texture = textures.plaster, .repeat_m = 1.2};
  furnishing.cover(wall(0), 0, Shape::kHeight_m, plaster);
  if (index == 0) furnishing.cover(wall(3), 0, Shape::kHeight_m, plaster);
  if (index == Shape::kSections - 1) furnishing.cover(wall(1), 0, Shape::kHeight_m, plaster);
  const std::vector<Lamp> lamps = {{{-1.1, 0.2, Shape::kHeight_m - 0.4}, 1.0},
                                   {{1.1, 0.2, Shape::kHeight_m - 0.4}, 1.0}};
  bake_light(builder.scene(), lamps, 0.5);
  return std::move(builder.scene());
}

}  // namespace

SimulatedScene make_gallery(std::uint64_t seed) {
  random::RandomSequence random(random::mix_key(seed, 25));
  SimulatedScene scene;
  int contents = random.below(kContents);
  for (int i = 0; i < Shape::kSections; ++i) {
    const SimulatedScene section = make_section(i, static_cast<Contents>(contents), random.bits());
    const std::int32_t first_texture = add_part_textures(scene, section);
    add_part(scene, section, first_texture, {(i + 0.5) * Shape::kSection_m, 0, 0});
    contents = (contents + 1 + random.below(kContents - 1)) % kContents;  // different from the previous one
  }
  color_vertices(scene);
  scene.free_space = {Vector3d(0.7, -0.7, 0.9), Vector3d(2 * Shape::kSection_m, 0.4, 1.9)};
  scene.look_at = {Vector3d(0, 0.4, 0.3), Vector3d(2 * Shape::kSection_m, Shape::kFurnishedWall_m, 1.9)};
  return scene;
}

}  // namespace fusebench::simulator::scene
