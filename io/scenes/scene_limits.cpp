// What of a scene each format cannot say.
#include <algorithm>

#include "io/scenes/scene_writers.h"

namespace rubble {
namespace {

template <typename Matches>
std::string count_joints(const SimScene& scene, const Matches& matches, const std::string& sentence) {
  std::size_t count = 0;
  for (const SimModel& model : scene.models) count += std::size_t(std::count_if(model.joints.begin(), model.joints.end(), matches));
  return count == 0 ? "" : std::to_string(count) + (count == 1 ? " joint " : " joints ") + sentence;
}

bool is_ball(const SimJoint& joint) { return joint.kind == JointKind::ball && !joint.loop; }
bool is_loop(const SimJoint& joint) { return joint.loop; }
bool is_sprung_ball(const SimJoint& joint) { return is_ball(joint) && joint.stiffness > 0; }
bool is_sprung(const SimJoint& joint) { return joint.stiffness > 0; }
bool is_dry(const SimJoint& joint) { return joint.friction > 0; }
bool is_mimic(const SimJoint& joint) { return joint.mimics >= 0; }
bool is_slider_loop(const SimJoint& joint) { return joint.loop && joint.kind == JointKind::slider; }

std::vector<std::string> drop_empty(std::vector<std::string> sentences) {
  sentences.erase(std::remove_if(sentences.begin(), sentences.end(), [](const std::string& s) { return s.empty(); }), sentences.end());
  return sentences;
}

constexpr char kSlackBalls[] = "of the kind ball: the springs are left out, damping and dry friction are kept";
constexpr char kFreeMimics[] = "with `mimic`: each moves by itself";

}  // namespace

std::vector<std::string> mjcf_limits(const SimScene& scene) {
  return drop_empty({count_joints(scene, is_sprung_ball, kSlackBalls),
                     count_joints(scene, is_slider_loop, "of the kind slider that close a loop are left out"),
                     scene.surfaces.empty() ? "" : "the contacts of terrain and street are a height field, without overhangs"});
}

std::vector<std::string> sdf_limits(const SimScene& scene) {
  return drop_empty({count_joints(scene, is_sprung_ball, "of the kind ball: springs, damping and dry friction are left out"),
                     count_joints(scene, is_mimic, kFreeMimics)});
}

std::vector<std::string> urdf_limits(const SimScene& scene) {
  return drop_empty({count_joints(scene, is_ball, "of the kind ball: each became three hinges without limits"),
                     count_joints(scene, is_loop, "that close a loop are left out"),
                     count_joints(scene, is_sprung, "with a spring: the springs are left out"),
                     scene.cameras.empty() ? "" : "cameras are in scene.json alone"});
}

std::vector<std::string> usd_limits(const SimScene& scene) {
  return drop_empty({count_joints(scene, is_sprung_ball, "of the kind ball: springs and damping are left out"),
                     count_joints(scene, is_dry, "with dry friction: the friction is left out"),
                     count_joints(scene, is_mimic, kFreeMimics)});
}

}  // namespace rubble
