#include "kernel/multibody/tree.h"

namespace rubble {

void number_coordinates(Tree& tree) {
  tree.q_count = tree.u_count = 0;
  for (TreeLink& link : tree.links) {
    link.first_q = tree.q_count;
    link.first_u = tree.u_count;
    tree.q_count += coordinate_count(link.mobility);
    tree.u_count += speed_count(link.mobility);
  }
}

}  // namespace rubble
