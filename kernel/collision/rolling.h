// Round pieces that turn fast. Contact points keep their arms for a whole step; a wheel that turns far in
// it would be pushed at points that are long elsewhere. What is round about the axis that it turns about
// looks the same however far it has turned: it is carried below that axis, as an ideal wheel or roller.
#pragma once

#include "kernel/collision/manifold.h"
#include "kernel/collision/narrow_phase.h"

namespace rubble {

// Whether a part rolls along a contact: its piece turns by more than 0.1 rad in the step, about an axis
// that is not near the normal, and the part reaches equally far in all directions across that axis, to
// 0.5 %, as a prism of 32 sides does. normal: of the contact, unit length, either way.
bool rolls(const PosedBody& body, const Vec3f& normal, float step);

// Leaves at most two points, the lowest of either half along the axis, and puts them below it: turning
// neither opens nor closes their gaps. centre: the centre of mass of the piece that rolls, in the frame of
// the points; unit: m.
void carry_below_axis(Manifold& manifold, const Vec3f& normal, const Vec3f& angular,
                      const Vec3f& centre);

}  // namespace rubble
