#include "kernel/multibody/tree_dynamics.h"

#include "kernel/multibody/tree_joint.h"

namespace rubble {
namespace {

// Inertia of one or several links about the reference.
struct SpatialInertia {
  double mass = 0;
  Vec3 first;    // mass times the centre of mass
  Mat3 moments;  // about the reference

  Spatial operator*(const Spatial& motion) const {
    return {moments * motion.angular + cross(first, motion.linear),
            motion.linear * mass + cross(motion.angular, first)};
  }
  SpatialInertia& operator+=(const SpatialInertia& o) {
    mass += o.mass;
    first += o.first;
    moments = moments + o.moments;
    return *this;
  }
};

SpatialInertia calc_inertia(const Body& body, const TreePose& pose, std::size_t link) {
  const Vec3 c = pose.world_from_com[link].translation - pose.reference;
  SpatialInertia inertia;
  inertia.mass = body.mass;
  inertia.first = c * body.mass;
  const double c2 = dot(c, c);  // parallel axes: + m (c.c 1 - c c^T)
  const Mat3 shift{{Vec3{c2, 0, 0} - c * c.x, Vec3{0, c2, 0} - c * c.y, Vec3{0, 0, c2} - c * c.z}};
  inertia.moments = pose.inertia[link] + shift * body.mass;
  return inertia;
}

// Turning about an axis through a point.
Spatial turning(const Vec3& axis, const Vec3& point, const Vec3& reference) {
  return {axis, cross(point - reference, axis)};
}

void set_axes(const TreeLink& link, const Quat& world_from_joint, const Vec3& point,
              const Vec3& reference, Spatial* axes) {
  const Mat3 r = world_from_joint.matrix();
  switch (link.mobility) {
    case Mobility::free: {
      const Mat3 one = Mat3::identity();
      for (int i = 0; i < 3; ++i) {
        axes[i] = turning(one.rows[i], point, reference);
        axes[3 + i] = {{}, one.rows[i]};
      }
      break;
    }
    case Mobility::ball:
      for (int i = 0; i < 3; ++i) axes[i] = turning(r.column(i), point, reference);
      break;
    case Mobility::hinge:
      axes[0] = turning(r.column(2), point, reference);
      break;
    case Mobility::slider:
      axes[0] = {{}, r.column(0)};
      break;
    default:
      break;
  }
}

}  // namespace

void TreePose::set(const Tree& tree, const std::vector<Body>& bodies, const std::vector<double>& q,
                   const Vec3& reference_point) {
  reference = reference_point;
  const std::size_t count = tree.links.size();
  world_from_com.resize(count);
  joint_position.resize(count);
  inertia.resize(count);
  axes.resize(std::size_t(tree.u_count));
  for (std::size_t i = 0; i < count; ++i) {
    const TreeLink& link = tree.links[i];
    const Pose joint = calc_joint_pose(link, q.data());
    Pose base;
    if (link.parent < 0) {
      world_from_com[i] = link.mobility == Mobility::fixed ? tree.root : joint;
      joint_position[i] = world_from_com[i].translation;
    } else {
      base = world_from_com[std::size_t(link.parent)] * link.parent_from_joint;
      const Pose end = base * joint;
      world_from_com[i] = end * link.link_from_joint.inverse();
      world_from_com[i].rotation = normalized(world_from_com[i].rotation);
      joint_position[i] = end.translation;
    }
    if (link.mobility == Mobility::fixed) continue;
    const Mat3 turned = world_from_com[i].rotation.matrix();
    inertia[i] = turned * bodies[std::size_t(link.body)].inertia * turned.transposed();
    set_axes(link, base.rotation, joint_position[i], reference, axes.data() + link.first_u);
  }
}

void calc_mass_matrix(const Tree& tree, const std::vector<Body>& bodies, const TreePose& pose,
                      SymmetricMatrix& mass) {
  mass.resize(tree.u_count);
  std::vector<SpatialInertia> composite(tree.links.size());
  for (std::size_t i = tree.links.size(); i-- > 0;) {
    const TreeLink& link = tree.links[i];
    if (link.mobility == Mobility::fixed) continue;
    composite[i] += calc_inertia(bodies[std::size_t(link.body)], pose, i);
    for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
      const Spatial momentum = composite[i] * pose.axes[std::size_t(k)];
      for (std::int32_t up = std::int32_t(i); up >= 0; up = tree.links[std::size_t(up)].parent) {
        const TreeLink& other = tree.links[std::size_t(up)];
        for (int j = other.first_u; j < other.first_u + speed_count(other.mobility) && j <= k;
             ++j) {
          mass.at(k, j) = dot(pose.axes[std::size_t(j)], momentum);
        }
      }
    }
    if (link.parent >= 0) composite[std::size_t(link.parent)] += composite[i];
  }
}

void calc_motions(const Tree& tree, const TreePose& pose, const std::vector<double>& u,
                  std::vector<Spatial>& motions) {
  motions.assign(tree.links.size(), {});
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (link.parent >= 0) motions[i] = motions[std::size_t(link.parent)];
    for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
      motions[i] += pose.axes[std::size_t(k)] * u[std::size_t(k)];
    }
  }
}

void calc_momenta(const Tree& tree, const std::vector<Body>& bodies, const TreePose& pose,
                  const std::vector<Spatial>& motions, std::vector<Spatial>& momenta) {
  momenta.assign(tree.links.size(), {});
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    if (tree.links[i].mobility == Mobility::fixed) continue;
    const Body& body = bodies[std::size_t(tree.links[i].body)];
    const Vec3 linear = calc_com_velocity(pose, i, motions[i]) * body.mass;
    const Vec3 arm = pose.world_from_com[i].translation - pose.reference;
    momenta[i] = {pose.inertia[i] * motions[i].angular + cross(arm, linear), linear};
  }
}

void calc_bias_forces(const Tree& tree, const std::vector<Body>& bodies, const TreePose& pose,
                      const std::vector<double>& u, const std::vector<Spatial>& motions,
                      const std::vector<Spatial>& momenta, std::vector<Spatial>& forces) {
  forces.assign(tree.links.size(), {});
  std::vector<Spatial> accelerations(tree.links.size());
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (link.mobility == Mobility::fixed) continue;
    Spatial& a = accelerations[i];
    if (link.mobility == Mobility::free) {
      // Turns about its own centre of mass, which moves.
      a.linear = cross(calc_com_velocity(pose, i, motions[i]), motions[i].angular);
    } else {
      // The joint's axes move with the parent.
      const Spatial& parent = motions[std::size_t(link.parent)];
      Spatial joint;
      for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
        joint += pose.axes[std::size_t(k)] * u[std::size_t(k)];
      }
      a = accelerations[std::size_t(link.parent)];
      a.angular += cross(parent.angular, joint.angular);
      a.linear += cross(parent.angular, joint.linear) + cross(parent.linear, joint.angular);
    }
    const Spatial inert = calc_inertia(bodies[std::size_t(link.body)], pose, i) * a;
    const Spatial &v = motions[i], &p = momenta[i];
    forces[i].angular = inert.angular + cross(v.angular, p.angular) + cross(v.linear, p.linear);
    forces[i].linear = inert.linear + cross(v.angular, p.linear);
  }
}

void gather(const Tree& tree, const TreePose& pose, std::vector<Spatial>& forces,
            std::vector<double>& generalized) {
  generalized.assign(std::size_t(tree.u_count), 0);
  for (std::size_t i = tree.links.size(); i-- > 0;) {
    const TreeLink& link = tree.links[i];
    for (int k = link.first_u; k < link.first_u + speed_count(link.mobility); ++k) {
      generalized[std::size_t(k)] = dot(pose.axes[std::size_t(k)], forces[i]);
    }
    if (link.parent >= 0) forces[std::size_t(link.parent)] += forces[i];
  }
}

}  // namespace rubble
