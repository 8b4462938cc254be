#include "app/fines/seen_fines.h"

#include <memory>

#include "kernel/geometry/fine_heaps.h"
#include "render/scene/frame.h"

namespace rubble {

std::uint16_t fine_label(const Scenario& scenario, const AssetLibrary& assets, FineKind kind) {
  const std::size_t robots = scenario.robots.empty() ? 0 : 1;
  return std::uint16_t(std::size_t(kFirstAssetLabel) + assets.types.size() + robots + std::size_t(kind));
}

void add_fines(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile, Scene& scene) {
  std::uint32_t number = kFirstFineHeap;
  for (FineHeap& heap : make_fine_heaps(pile.fines)) {
    SceneInstance instance;
    instance.mesh = std::uint32_t(scene.meshes.size());
    instance.world_from_body = world_from_host(pile, heap.host);
    instance.id = number++;
    instance.label = fine_label(scenario, assets, heap.kind);
    SceneMesh mesh;
    mesh.levels.push_back(std::move(heap.mesh));
    scene.meshes.push_back(std::make_shared<const SceneMesh>(std::move(mesh)));
    scene.instances.push_back(instance);
  }
}

void add_fines(const PileState& pile, PileModel& model) {
  std::size_t number = kFirstFineHeap;
  for (FineHeap& heap : make_fine_heaps(pile.fines)) {
    const std::string name = piece_name(fine_names()[std::size_t(heap.kind)], number);
    const auto mesh = std::make_shared<const TriangleMesh>(std::move(heap.mesh));
    model.kept.push_back(mesh);
    model.pieces.push_back({std::uint32_t(model.types.size()), name, 1, world_from_host(pile, heap.host),
                            std::int32_t(number)});
    model.types.push_back({name, mesh.get()});
    ++number;
  }
}

void add_fines(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile, Legend& legend) {
  legend.first_fine = kFirstFineHeap;
  for (const FineHeap& heap : make_fine_heaps(pile.fines))
    legend.fines.push_back({fine_label(scenario, assets, heap.kind), fine_names()[std::size_t(heap.kind)]});
}

std::vector<int> find_heap_hosts(const PileState& pile) {
  std::vector<int> hosts;
  for (const FineHeap& heap : make_fine_heaps(pile.fines)) hosts.push_back(heap.host);
  return hosts;
}

}  // namespace rubble
