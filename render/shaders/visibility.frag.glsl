// Placed mesh + 1 (0: nothing) and the triangle's last vertex, see geometry.cpp.
#ifndef SHADOW
flat in uvec2 named;
layout(location = 0) out uvec2 visible;
#endif

void main() {
#ifndef SHADOW
  visible = named;
#endif
}
