#include "app/simulators/build_sim_scene.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "app/fines/pile_fines.h"
#include "app/scene/build_scene.h"
#include "app/scene/look_pictures.h"
#include "io/scenes/pile_export.h"
#include "kernel/base/error.h"
#include "kernel/base/inertia.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/geometry/shape.h"
#include "kernel/model/settled_joints.h"
#include "kernel/surroundings/make_surroundings.h"

namespace rubble {
namespace {

constexpr int kManyFreePieces = 300;  // beyond so many no common engine keeps up with real time

std::string count_text(std::size_t count, const char* one, const char* several) {
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

// The current position of a hinge or slider.
double calc_position(JointKind kind, const Pose& joint_moved) {
  const Quat& r = joint_moved.rotation;
  if (kind == JointKind::hinge) return 2 * portable::atan2(r.w < 0 ? -r.z : r.z, r.w < 0 ? -r.w : r.w);
  return kind == JointKind::slider ? joint_moved.translation.x : 0;
}

class SceneBuilder {
 public:
  SceneBuilder(const ResolvedMission& mission, const PileState& pile, const DynamicChoice& dynamic, int threads)
      : mission_(mission), assets_(mission.assets), pile_(pile), dynamic_(dynamic) {
    model_.pile = build_pile_model(assets_, pile);
    add_look_pictures(model_.pile, threads);
    model_.pile.gravity = mission.scenario.settle.gravity;
  }

  BuiltScene build(const std::vector<MissionRobot>& robots) {
    group_pieces();
    hang_groups();
    for (const Group& group : groups_)
      if (group.parent_joint == nullptr) add_tree(int(&group - groups_.data()));
    add_fines_and_surroundings();
    add_street();
    add_robots(mission_.scenario, robots, model_.sim, notes_);
    add_cameras(mission_.scenario, robots, model_.sim, notes_);
    note_what_is_left_out();
    return {std::move(model_), std::move(notes_)};
  }

 private:
  // Pieces that move as one: a group of a building, or a piece alone.
  struct Group {
    std::vector<std::int32_t> pieces;  // ascending
    bool fixed = false;
    const SettledJoint* parent_joint = nullptr;  // to the group that it hangs on
    std::vector<int> children;                   // groups
    std::vector<const SettledJoint*> loops;      // of which it is the child
    SimLink link;
  };

  void group_pieces() {
    std::vector<const std::vector<std::int32_t>*> body_of(pile_.pieces.size(), nullptr);
    for (const std::vector<std::int32_t>& body : pile_.building.bodies)
      for (const std::int32_t piece : body) body_of[std::size_t(piece)] = &body;
    group_of_.assign(pile_.pieces.size(), -1);
    for (std::size_t i = 0; i < pile_.pieces.size(); ++i) {
      if (group_of_[i] >= 0 || pile_.pieces[i].status == PieceStatus::lost || is_surface(i)) continue;
      Group group;
      group.pieces = body_of[i] ? *body_of[i] : std::vector<std::int32_t>{std::int32_t(i)};
      for (const std::int32_t piece : group.pieces) {
        group_of_[std::size_t(piece)] = int(groups_.size());
        group.fixed = group.fixed || pile_.pieces[std::size_t(piece)].status == PieceStatus::fixed;
      }
      group.link = make_link(group.pieces);
      groups_.push_back(std::move(group));
    }
    for (std::size_t i = 0; i < pile_.pieces.size(); ++i)
      if (is_surface(i)) add_surface(i);
  }

  const PieceType& type_of(std::size_t piece) const { return assets_.types[std::size_t(pile_.pieces[piece].type)]; }
  bool is_surface(std::size_t piece) const { return type_of(piece).surface != nullptr; }

  // Terrain: seen, and felt by its triangles.
  void add_surface(std::size_t index) {
    const PieceState& piece = pile_.pieces[index];
    const PieceType& type = type_of(index);
    const std::string name = piece_name(type.name, index);
    model_.sim.surfaces.push_back({name, type.surface, piece.world_from_body, piece.scale, type.friction});
    SimLink link;
    link.name = name, link.label = type.name, link.number = std::int32_t(index);
    link.world_from_link = piece.world_from_body;
    SimPart part;
    part.mesh = mesh_of(std::uint32_t(piece.type)), part.scale = piece.scale;
    link.parts = {part};
    add_fixed(link);
  }

  void add_fixed(const SimLink& link) {
    SimModel model;
    model.name = link.name, model.fixed = true;
    model.links = {link};
    model_.sim.models.push_back(std::move(model));
  }

  int mesh_of(std::uint32_t type) {
    const auto [found, is_new] = meshes_.try_emplace(type, int(model_.sim.meshes.size()));
    if (is_new) model_.sim.meshes.push_back({model_.pile.types[type].name, model_.pile.types[type].mesh});
    return found->second;
  }

  // The kernel's convex parts, and its volume at density 1.
  struct Compiled {
    int shape = 0;
    VolumeProperties volume;
  };
  const Compiled& compile(std::int32_t index) {
    const auto [found, is_new] = compiled_.try_emplace(index);
    if (!is_new) return found->second;
    const PieceType& type = assets_.types[std::size_t(index)];
    found->second.volume = compile_shape(type, type.name).volume;
    found->second.shape = int(model_.sim.shapes.size());
    SimShape shape{type.name, {}};
    for (const ConvexPart& part : type.parts) shape.hulls.push_back(calc_hull(part.points));
    model_.sim.shapes.push_back(std::move(shape));
    return found->second;
  }

  // In the frame of the first piece.
  SimLink make_link(const std::vector<std::int32_t>& pieces) {
    SimLink link;
    const std::size_t first = std::size_t(pieces.front());
    link.label = type_of(first).name;
    link.name = piece_name(link.label, first);
    link.number = pieces.front();
    link.world_from_link = pile_.pieces[first].world_from_body;
    std::vector<double> masses;
    std::vector<Vec3> centres;
    std::vector<Mat3> inertias;
    for (const std::int32_t index : pieces) {
      const PieceState& piece = pile_.pieces[std::size_t(index)];
      const PieceType& type = type_of(std::size_t(index));
      const Compiled compiled = compile(piece.type);
      SimPart part;
      part.mesh = mesh_of(std::uint32_t(piece.type)), part.shape = compiled.shape, part.scale = piece.scale;
      part.link_from_part = index == pieces.front() ? Pose{} : link.world_from_link.inverse() * piece.world_from_body;
      part.friction = type.friction;
      link.parts.push_back(part);
      const double s = piece.scale, s3 = s * s * s;
      const Mat3 turn = part.link_from_part.rotation.matrix();
      masses.push_back(type.density * compiled.volume.volume * s3);
      centres.push_back(part.link_from_part * (compiled.volume.centre_of_mass * s));
      inertias.push_back(turn * (compiled.volume.inertia * (type.density * s3 * s * s)) * turn.transposed());
      link.mass += masses.back();
      link.centre_of_mass += centres.back() * masses.back();
    }
    link.centre_of_mass *= 1 / link.mass;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      link.inertia = link.inertia + inertias[i];
      if (pieces.size() > 1) add_offset(link.inertia, masses[i], centres[i] - link.centre_of_mass);
    }
    return link;
  }

  void hang_groups() {
    if (pile_.joints.empty()) return;
    laid_ = make_laid_pile(mission_, pile_);
    joints_ = list_settled_joints(laid_, pile_);
    for (const SettledJoint& joint : joints_) {
      const int parent = group_of_[std::size_t(joint.state->parent)], child = group_of_[std::size_t(joint.state->child)];
      if (parent < 0 || child < 0 || !joint.type) continue;
      if (joint.loop) {
        groups_[std::size_t(child)].loops.push_back(&joint);
        continue;
      }
      groups_[std::size_t(child)].parent_joint = &joint;
      groups_[std::size_t(parent)].children.push_back(child);
    }
  }

  bool is_near(const SimLink& link) const {
    Vec3 away = link.world_from_link * link.centre_of_mass - dynamic_.centre;
    if (dynamic_.upright) away.z = 0;
    return norm(away) < dynamic_.radius;
  }

  // A piece with all that hangs on it, which moves together or not at all.
  void add_tree(int root) {
    std::vector<int> members{root};
    for (std::size_t i = 0; i < members.size(); ++i)
      for (const int child : groups_[std::size_t(members[i])].children) members.push_back(child);
    bool moves = dynamic_.kind == DynamicChoice::Kind::all;
    if (dynamic_.kind == DynamicChoice::Kind::near)
      moves = std::any_of(members.begin(), members.end(), [&](int m) { return is_near(groups_[std::size_t(m)].link); });
    const bool fixed = groups_[std::size_t(root)].fixed;
    if (!moves || (fixed && members.size() == 1)) {
      for (const int m : members) {
        note_model(groups_[std::size_t(m)], int(model_.sim.models.size()), 0);
        add_fixed(groups_[std::size_t(m)].link);
      }
      return;
    }
    SimModel model;
    model.name = groups_[std::size_t(root)].link.name;
    model.fixed = fixed;
    std::map<int, int> link_of;  // by group
    for (const int m : members) {
      link_of[m] = int(model.links.size());
      note_model(groups_[std::size_t(m)], int(model_.sim.models.size()), link_of[m]);
      model.links.push_back(groups_[std::size_t(m)].link);
    }
    for (const int m : members) {
      const Group& group = groups_[std::size_t(m)];
      if (m != root) model.joints.push_back(make_joint(*group.parent_joint, link_of));
      for (const SettledJoint* loop : group.loops) {
        if (link_of.count(group_of_[std::size_t(loop->state->parent)]) == 0)
          ++loops_between_trees_;
        else
          model.joints.push_back(make_joint(*loop, link_of));
      }
    }
    free_pieces_ += int(members.size()) - (fixed ? 1 : 0);
    model_.sim.models.push_back(std::move(model));
  }

  void note_model(const Group& group, int model, int link) {
    for (const std::int32_t piece : group.pieces) places_[piece] = {model, link};
  }

  // Figures of another scale as in Joint::set_figures() of kernel/multibody.
  SimJoint make_joint(const SettledJoint& from, const std::map<int, int>& link_of) {
    const JointState& state = *from.state;
    const JointType& type = *from.type;
    const double s = from.scale;
    SimJoint joint;
    joint.name = "joint_" + index_text(state.parent) + "_" + index_text(state.child);
    joint.parent = link_of.at(group_of_[std::size_t(state.parent)]), joint.child = link_of.at(group_of_[std::size_t(state.child)]);
    joint.kind = state.kind;
    joint.parent_from_joint = state.parent_from_joint, joint.child_from_joint = state.child_from_joint;
    const bool slides = state.kind == JointKind::slider;
    if (slides) joint.axis = {1, 0, 0};
    const Pose& parent = pile_.pieces[std::size_t(state.parent)].world_from_body;
    const Pose& child = pile_.pieces[std::size_t(state.child)].world_from_body;
    joint.position = calc_position(state.kind, (parent * state.parent_from_joint).inverse() * (child * state.child_from_joint));
    joint.loop = from.loop;
    if (type.break_force < kNever || type.break_torque < kNever) ++breakable_;
    if (type.yield < kNever) ++yielding_;
    if (joint.loop || state.kind == JointKind::weld) return joint;
    const double torque = slides ? s * s : s * s * s;
    joint.lower = type.lower * (slides ? s : 1), joint.upper = type.upper * (slides ? s : 1);
    joint.stiffness = type.stiffness * (slides ? s : torque), joint.damping = type.damping * (slides ? s * s : torque * s);
    joint.friction = type.friction * torque;
    joint.rest = state.rest;
    return joint;
  }

  // Fines have no contacts: they are seen, and go with the piece that they lie on.
  void add_fines_and_surroundings() {
    const std::vector<FineHeap>& heaps = pile_.fines.heaps();
    for (const PileModel::Piece& piece : model_.pile.pieces) {
      if (piece.number < kFirstFineHeap) continue;
      SimPart part;
      part.mesh = mesh_of(piece.type), part.scale = piece.scale;
      if (piece.number < kFirstSurrounding) {
        ++heaps_;
        const auto at = places_.find(heaps[std::size_t(piece.number - kFirstFineHeap)].host);
        if (at != places_.end()) {
          SimModel& carrier = model_.sim.models[std::size_t(at->second.first)];
          SimLink& link = carrier.links[std::size_t(at->second.second)];
          part.link_from_part = link.world_from_link.inverse() * piece.world_from_body;
          link.parts.push_back(part);
          continue;
        }
      }
      SimLink link;
      link.name = piece.name, link.label = piece.name.substr(0, piece.name.rfind('_')), link.number = piece.number;
      link.world_from_link = piece.world_from_body;
      link.parts = {part};
      add_fixed(link);
    }
  }

  // What robots feel of the surroundings, as the kernel has it.
  void add_street() {
    if (!pile_.surroundings) return;
    auto mesh = std::make_shared<TriangleMesh>(make_solid_surface(*pile_.surroundings, kFeltReach));
    if (mesh->triangles.empty()) return;
    model_.sim.surfaces.push_back({"surroundings", std::move(mesh), {}, 1, kSurroundingsFriction});
  }

  void note_what_is_left_out() {
    if (heaps_ > 0) notes_.push_back("fines have no contacts: each heap is only seen, with the piece that it lies on");
    if (dynamic_.kind == DynamicChoice::Kind::none) return;
    std::size_t ties = 0;
    for (const TieState& tie : pile_.building.ties) ties += is_free(tie.piece_a) || is_free(tie.piece_b) ? 1 : 0;
    if (ties > 0)
      notes_.push_back(count_text(ties, "tie of reinforcing bars is", "ties of reinforcing bars are") +
                       " left out: what hangs on them falls");
    if (breakable_ > 0) notes_.push_back(count_text(std::size_t(breakable_), "joint breaks", "joints break") + " in Rubble under load and never in a simulator");
    if (yielding_ > 0) notes_.push_back(count_text(std::size_t(yielding_), "spring yields", "springs yield") + " in Rubble and not in a simulator");
    if (loops_between_trees_ > 0)
      notes_.push_back(count_text(std::size_t(loops_between_trees_), "joint", "joints") + " between pieces that hang on no common one are left out");
    if (free_pieces_ > kManyFreePieces)
      notes_.push_back(std::to_string(free_pieces_) + " pieces are free: common engines need minutes for a second of that; "
                       "`--dynamic near=X,Y,Z,R` frees those in a sphere");
    if (free_pieces_ == 0) notes_.push_back("no piece is free: all are fixed, or none is in the region of --dynamic");
  }

  bool is_free(std::int32_t piece) const {
    const auto at = places_.find(piece);
    return at != places_.end() && !model_.sim.models[std::size_t(at->second.first)].fixed;
  }

  const ResolvedMission& mission_;
  const AssetLibrary& assets_;
  const PileState& pile_;
  const DynamicChoice& dynamic_;
  ExportModel model_;
  std::vector<std::string> notes_;
  std::vector<Group> groups_;
  std::vector<int> group_of_;  // by piece; -1: none
  std::map<std::uint32_t, int> meshes_;
  std::map<std::int32_t, Compiled> compiled_;
  std::map<std::int32_t, std::pair<int, int>> places_;  // model and link of each piece
  Pile laid_;
  std::vector<SettledJoint> joints_;
  int heaps_ = 0, breakable_ = 0, yielding_ = 0, loops_between_trees_ = 0, free_pieces_ = 0;
};

[[noreturn]] void refuse_region(const std::string& text, const std::string& key) {
  throw InputError({"", 0, key, "not a choice of pieces that may move",
                    "all, none, near=X,Y,R (an upright cylinder) or near=X,Y,Z,R (a sphere), in metres", "`" + text + "`", ""});
}

}  // namespace

DynamicChoice parse_dynamic(const std::string& text, const std::string& key) {
  DynamicChoice choice;
  if (text == "none") return choice;
  choice.kind = DynamicChoice::Kind::all;
  if (text == "all") return choice;
  choice.kind = DynamicChoice::Kind::near;
  if (text.compare(0, 5, "near=") != 0) refuse_region(text, key);
  std::vector<double> numbers;
  const char *at = text.data() + 5, *const end = text.data() + text.size();
  for (;;) {
    double number = 0;
    const auto read = std::from_chars(at, end, number);
    if (read.ec != std::errc() || !(std::abs(number) < 1e6)) refuse_region(text, key);
    numbers.push_back(number);
    if (read.ptr == end) break;
    if (*read.ptr != ',') refuse_region(text, key);
    at = read.ptr + 1;
  }
  if ((numbers.size() != 3 && numbers.size() != 4) || numbers.back() <= 0) refuse_region(text, key);
  choice.upright = numbers.size() == 3;
  choice.centre = {numbers[0], numbers[1], choice.upright ? 0 : numbers[2]};
  choice.radius = numbers.back();
  return choice;
}

bool needs_scene(const std::vector<std::string>& formats) {
  return std::any_of(formats.begin(), formats.end(), [](const std::string& name) { return find_mesh_format(name).is_folder; });
}

ExportModel build_mesh_model(const AssetLibrary& assets, const PileState& pile, const std::vector<std::string>& formats, int threads) {
  ExportModel model;
  model.pile = build_pile_model(assets, pile);
  if (std::find(formats.begin(), formats.end(), "glb") != formats.end()) add_look_pictures(model.pile, threads);
  return model;
}

BuiltScene build_sim_scene(const ResolvedMission& mission, const PileState& pile, const std::vector<MissionRobot>& robots,
                           const DynamicChoice& dynamic, int threads) {
  return SceneBuilder(mission, pile, dynamic, threads).build(robots);
}

std::vector<std::string> list_notes(const BuiltScene& built, const std::vector<std::string>& formats) {
  std::vector<std::string> notes = built.notes;
  for (const std::string& name : formats) {
    const MeshFormat& format = find_mesh_format(name);
    if (!format.limits) continue;
    for (const std::string& limit : format.limits(built.model.sim)) notes.push_back(name + ": " + limit);
  }
  return notes;
}

}  // namespace rubble
