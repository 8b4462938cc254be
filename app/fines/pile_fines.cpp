#include "app/fines/pile_fines.h"

#include <memory>

#include "io/state/fines_file.h"
#include "kernel/base/hash.h"
#include "kernel/geometry/fine_shapes.h"

namespace rubble {
namespace {

// Of each kind: what was asked for, and what there is.
std::string describe_missing(const FinesSpec& spec, const Fines& fines) {
  std::size_t drifts = 0, strands = 0, sheets = 0;
  for (const FineSheet& sheet : fines.sheets) {
    drifts += sheet.kind == FineKind::dust, strands += sheet.kind == FineKind::cable || sheet.kind == FineKind::pipe;
    sheets += sheet.kind == FineKind::paper || sheet.kind == FineKind::cloth;
  }
  const auto lacks = [](std::size_t found, int asked, const char* what) {
    return int(found) >= asked ? "" : " " + std::to_string(found) + " of " + std::to_string(asked) + " " + what + ",";
  };
  std::string text = lacks(fines.pieces.size() + sheets, spec.amount, "loose pieces") +
                     lacks(drifts, spec.drifts, "drifts") + lacks(strands, spec.cables + spec.pipes, "cables and pipes");
  if (text.empty()) return {};
  text.back() = ';';
  return "fines:" + text + " the pile has no room for more";
}

}  // namespace

std::string lay_fines(const FinesSpec& spec, std::uint64_t seed, const AssetLibrary& assets, int threads, PileState& pile,
                      const FinesProgress& progress) {
  if (spec.amount == 0) return {};
  pile.fines = strew_fines(pile, assets.finest_meshes(), spec, {seed, threads, assets.terrain(), progress});
  return describe_missing(spec, pile.fines);
}

std::uint64_t hash_fines_work(const FinesSpec& f, std::uint64_t seed, std::uint64_t pile) {
  if (f.amount == 0) return pile;
  StateHash hash;
  hash.add(pile), hash.add(seed);
  for (const int count : {f.amount, f.drifts, f.cables, f.pipes}) hash.add(std::int32_t(count));
  for (const double number : {f.grit, f.plaster, f.glass, f.paper, f.cloth, f.size[0], f.size[1], f.exponent})
    hash.add(number);
  return hash.digest();
}

void save_fines_of(const FinesSpec& spec, const PileState& pile, const std::string& folder) {
  if (spec.amount > 0) save_fines(pile.fines, folder + "/" + kFinesFile);
}

void load_fines_of(const FinesSpec& spec, const std::string& folder, PileState& pile) {
  if (spec.amount == 0) return;
  pile.fines = load_fines(folder + "/" + kFinesFile, pile.pieces.size());
  heap_fines(pile.fines);
}

void add_fines(const ClassLabels& labels, const PileState& pile, Scene& scene) {
  std::uint32_t number = kFirstFineHeap;
  for (const FineHeap& heap : pile.fines.heaps()) {
    SceneInstance instance;
    instance.mesh = std::uint32_t(scene.meshes.size());
    instance.world_from_body = world_from_host(pile, heap.host);
    instance.id = number++;
    instance.label = labels.of(heap.kind);
    SceneMesh mesh;
    mesh.levels.push_back(heap.mesh);
    scene.meshes.push_back(std::make_shared<const SceneMesh>(std::move(mesh)));
    scene.instances.push_back(instance);
  }
}

void add_fines(const PileState& pile, PileModel& model) {
  std::size_t number = kFirstFineHeap;
  for (const FineHeap& heap : pile.fines.heaps()) {
    const std::string name = piece_name(fine_names()[std::size_t(heap.kind)], number);
    const auto mesh = std::shared_ptr<const TriangleMesh>(pile.fines.gathered, &heap.mesh);
    model.kept.push_back(mesh);
    model.pieces.push_back({std::uint32_t(model.types.size()), name, 1, world_from_host(pile, heap.host),
                            std::int32_t(number)});
    model.types.push_back({name, mesh.get()});
    ++number;
  }
}

void add_fines(const ClassLabels& labels, const PileState& pile, Legend& legend) {
  legend.first_fine = kFirstFineHeap;
  for (const FineHeap& heap : pile.fines.heaps())
    legend.fines.push_back({labels.of(heap.kind), fine_names()[std::size_t(heap.kind)]});
}

}  // namespace rubble
