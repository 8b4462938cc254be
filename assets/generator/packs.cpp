#include <initializer_list>

#include "assets/generator/asset.h"
#include "assets/generator/car.h"
#include "assets/generator/pieces.h"
#include "kernel/base/error.h"

namespace rubble::generator {
namespace {

using Family = std::vector<Recipe> (*)();

Pack gather(const std::string& name, std::initializer_list<Family> families) {
  Pack pack{name, {}, {}};
  for (const Family family : families) {
    for (Recipe& recipe : family()) pack.recipes.push_back(std::move(recipe));
  }
  return pack;
}

std::vector<Recipe> cars() {
  return {make_car({"car_roof", 0.34, 0.3, 0.05, 0.05, 0.03, 0.025, 4, false}),
          make_car({"car_front", 0.06, 0.8, 0.0, 0.42, 0.0, 0.02, 4, true}),
          make_car({"car_side", 0.16, -0.2, -0.16, 0.0, 0.34, 0.03, 3, false}),
          make_car({"car_flat", 0.50, 0.0, 0.10, 0.18, 0.10, 0.04, 2, false})};
}

}  // namespace

std::vector<std::string> pack_names() {
  return {"concrete", "residential", "parking", "bridge", "victims"};
}

Pack make_pack(const std::string& name) {
  if (name == "concrete") {
    Pack pack = gather(name, {masonry_pieces, chunk_pieces, slab_pieces, frame_pieces, hollow_pieces,
                              concrete_fragments, rebar_pieces, facade_pieces});
    pack.articulated = articulated_concrete();
    return pack;
  }
  if (name == "residential") {
    Pack pack = gather(
        name, {timber_pieces, drywall_pieces, joinery_pieces, furniture_pieces, door_frames});
    pack.articulated = articulated_residential();
    return pack;
  }
  if (name == "parking") {
    Pack pack = gather(name, {cars, parking_concrete, guard_pieces, open_cars});
    pack.articulated = articulated_parking();
    return pack;
  }
  if (name == "bridge") return gather(name, {bridge_concrete, bridge_steel});
  if (name == "victims") return gather(name, {victim_pieces});
  throw RunError("there is no bundled pack " + name);
}

}  // namespace rubble::generator
