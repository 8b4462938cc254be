// Placed mesh + 1 (0: nothing) and triangle.
#ifndef SHADOW
flat in uvec2 draw_source;
layout(location = 0) out uvec2 visible;
#endif

void main() {
#ifndef SHADOW
  visible = uvec2(draw_source.x + 1u, draw_source.y + uint(gl_PrimitiveID));
#endif
}
