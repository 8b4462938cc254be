#include "mujoco_judge.h"

#include <mujoco/mujoco.h>

#include <cstring>
#include <sstream>
#include <stdexcept>

namespace rubble::testing {
namespace {

class Xml {
 public:
  Xml(const RobotModel& model, const Pose& base, const JudgeOptions& options)
      : model_(model), options_(options) {
    out_.precision(17);
    out_ << "<mujoco><compiler angle='radian' balanceinertia='false'/>"
         << "<option timestep='" << options.step << "' integrator='"
         << (options.fixed_base ? "RK4" : "implicit") << "' cone='elliptic' "
         << "impratio='100' noslip_iterations='20' gravity='0 0 -9.81'/><size njmax='4000' nconmax='1000'/>"
         // Stiff, and without the creep of its soft friction: what Coulomb says.
         << "<default><geom solref='" << 4 * options.step
         << " 1' solimp='0.98 0.999 0.0005' condim='3'"
         << (options.fixed_base ? " contype='0' conaffinity='0'" : "") << "/></default><asset>";
    for (std::size_t i = 0; i < model.links.size(); ++i) add_meshes(i);
    out_ << "</asset><worldbody>";
    if (options.ground) {
      out_ << "<geom type='plane' size='0 0 1' friction='" << options.ground_friction
           << " 0.01 0.0001'/>";
    }
    for (const auto& [centre, size] : options.boxes) {
      out_ << "<geom type='box' friction='" << options.ground_friction << " 0.01 0.0001' size='"
           << 0.5 * size.x << " " << 0.5 * size.y << " " << 0.5 * size.z << "' " << pos(centre) << "/>";
    }
    add_body(0, base);
    out_ << "</worldbody><actuator>";
    for (const RobotJoint& joint : model.joints) add_motor(joint);
    out_ << "</actuator></mujoco>";
  }
  std::string text() const { return out_.str(); }

 private:
  static std::string numbers(std::initializer_list<double> values) {
    std::ostringstream text;
    text.precision(17);
    for (double value : values) text << value << " ";
    return text.str();
  }
  static std::string pos(const Vec3& p) { return "pos='" + numbers({p.x, p.y, p.z}) + "'"; }
  static std::string mesh(std::size_t link, std::size_t part) {
    return "m" + std::to_string(link) + "_" + std::to_string(part);
  }
  void add_meshes(std::size_t link) {
    for (std::size_t k = 0; k < model_.links[link].parts.size(); ++k) {
      out_ << "<mesh name='" << mesh(link, k) << "' vertex='";
      for (const Vec3& p : model_.links[link].parts[k].points) out_ << numbers({p.x, p.y, p.z});
      out_ << "'/>";
    }
  }
  void add_body(std::size_t index, const Pose& at) {
    const RobotLink& link = model_.links[index];
    const Quat& q = at.rotation;
    out_ << "<body name='b" << index << "' " << pos(at.translation) << " quat='"
         << numbers({q.w, q.x, q.y, q.z}) << "'>";
    const auto& i = link.inertia.rows;
    out_ << "<inertial mass='" << link.mass << "' " << pos(link.centre_of_mass) << " fullinertia='"
         << numbers({i[0].x, i[1].y, i[2].z, i[0].y, i[0].z, i[1].z}) << "'/>";
    if (index == 0 && !options_.fixed_base) out_ << "<freejoint/>";
    if (index > 0) {
      const RobotJoint& joint = model_.joints[index - 1];
      out_ << "<joint name='j" << index << "' type='hinge' axis='"
           << numbers({joint.axis.x, joint.axis.y, joint.axis.z}) << "' damping='" << joint.damping
           << "'/>";
    }
    for (std::size_t k = 0; k < link.parts.size(); ++k) {
      out_ << "<geom type='mesh' mesh='" << mesh(index, k) << "' friction='" << link.friction
           << " 0.01 0.0001'/>";
    }
    for (const RobotJoint& joint : model_.joints) {
      if (joint.parent == int(index)) add_body(std::size_t(joint.child), joint.parent_from_child);
    }
    out_ << "</body>";
  }
  void add_motor(const RobotJoint& joint) {
    const RobotMotor& m = joint.motor;
    if (m.effort <= 0) return;
    out_ << "<general joint='j" << joint.child << "' biastype='affine' gainprm='" << m.stiffness
         << "' biasprm='0 " << -m.stiffness << " " << -m.damping << "' forcelimited='true' forcerange='"
         << -m.effort << " " << m.effort << "'/>";
  }

  const RobotModel& model_;
  const JudgeOptions& options_;
  std::ostringstream out_;
};

}  // namespace

struct MujocoJudge::State {
  mjModel* model = nullptr;
  mjData* data = nullptr;
  ~State() {
    if (data) mj_deleteData(data);
    if (model) mj_deleteModel(model);
  }
};

MujocoJudge::MujocoJudge(const RobotModel& model, const Pose& base, const JudgeOptions& options)
    : state_(std::make_unique<State>()) {
  const std::string xml = Xml(model, base, options).text();
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "robot.xml", int(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[1000] = {};
  state_->model = mj_loadXML("robot.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (!state_->model) throw std::runtime_error(error);
  state_->data = mj_makeData(state_->model);
  mj_forward(state_->model, state_->data);
}

MujocoJudge::~MujocoJudge() = default;

void MujocoJudge::set_positions(const std::vector<double>& targets) {
  for (std::size_t i = 0; i < targets.size() && int(i) < state_->model->nu; ++i) {
    state_->data->ctrl[i] = targets[i];
  }
}
void MujocoJudge::step() { mj_step(state_->model, state_->data); }
double MujocoJudge::time() const { return state_->data->time; }
Vec3 MujocoJudge::centre_of_mass() const {
  const mjtNum* p = state_->data->subtree_com;
  return {p[0], p[1], p[2]};
}
Vec3 MujocoJudge::link_origin(std::size_t link) const {
  const mjtNum* p = state_->data->xpos + 3 * (link + 1);
  return {p[0], p[1], p[2]};
}
int MujocoJudge::contacts() const { return state_->data->ncon; }

}  // namespace rubble::testing
