#include "kernel/fines/fine_surfaces.h"

namespace rubble {
namespace {

constexpr double kStray = 0.06;  // share of grit that is of a piece farther away
constexpr double kRender = 0.05;  // share of grit of concrete and masonry that is render that was on it

std::vector<FineSurface> fragments_of(const std::string& surface) {
  const auto is = [&surface](const char* begin) { return surface.rfind(begin, 0) == 0; };
  if (is("concrete")) return {FineSurface::concrete};
  if (is("brick")) return {FineSurface::brick, FineSurface::brick, FineSurface::brick_face};
  if (is("cinder_block")) return {FineSurface::block};
  if (is("plaster")) return {FineSurface::plaster};
  if (is("drywall")) return {FineSurface::gypsum};
  if (is("timber")) return {FineSurface::timber};
  if (is("glass")) return {FineSurface::glass};
  return {};
}

bool is_hard(FineSurface s) {
  return s == FineSurface::concrete || s == FineSurface::brick || s == FineSurface::block;
}

}  // namespace

const std::vector<std::string>& fine_surfaces() {
  static const std::vector<std::string> names{"concrete_fracture", "brick_fracture", "brick", "cinder_block",
                                              "plaster", "drywall_core", "timber_fracture", "rebar", "glass",
                                              "paper", "fabric", "dust", "rubber", "steel_galvanised"};
  return names;
}

FragmentTable::FragmentTable(const PileState& pile, const std::vector<const TriangleMesh*>& meshes)
    : pile_(pile), of_type_(meshes.size()) {
  for (std::size_t t = 0; t < meshes.size(); ++t) {
    if (!meshes[t]) continue;
    for (const std::string& surface : meshes[t]->surface_names)
      for (const FineSurface s : fragments_of(surface)) of_type_[t].push_back(s);
  }
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status != PieceStatus::lost && !of_type_[std::size_t(piece.type)].empty()) giving_.push_back(int(i));
  }
}

FineSurface FragmentTable::draw(int piece, RandomStream& random) const {
  const bool stray = random.uniform() < kStray, rendered = random.uniform() < kRender;
  const std::uint64_t any = random.next();
  const bool gives = piece >= 0 && !of_type_[std::size_t(pile_.pieces[std::size_t(piece)].type)].empty();
  if (!gives || stray) {
    if (giving_.empty()) return FineSurface::concrete;
    piece = giving_[any % giving_.size()];
  }
  const std::vector<FineSurface>& all = of_type_[std::size_t(pile_.pieces[std::size_t(piece)].type)];
  const FineSurface drawn = all[random.below(all.size())];
  return rendered && is_hard(drawn) ? FineSurface::plaster : drawn;
}

}  // namespace rubble
