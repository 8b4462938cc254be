#include "app/fines/seen_fines.h"

#include <memory>

#include "kernel/geometry/fine_heaps.h"

namespace rubble {

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
