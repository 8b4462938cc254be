// Only positions: everything else is looked up once a pixel when the image is resolved.
layout(location = 0) in vec3 position;  // mesh frame
// One record a draw: rows x, y and w of clip_from_mesh; placed mesh.
layout(location = 1) in vec4 clip_x;
layout(location = 2) in vec4 clip_y;
layout(location = 3) in vec4 clip_w;
layout(location = 4) in uint placed;
#ifdef SHADOW
layout(location = 5) in vec4 clip_z;
#else
flat out uvec2 named;
#endif

void main() {
  vec4 p = vec4(position, 1.0);
#ifdef SHADOW
  gl_Position = vec4(dot(clip_x, p), dot(clip_y, p), dot(clip_z, p), dot(clip_w, p));
#else
  // Reversed depth without a far plane: depth = near / Z.
  gl_Position = vec4(dot(clip_x, p), dot(clip_y, p), NEAR_PLANE, dot(clip_w, p));
  // Flat: of the triangle's last vertex, which is its own.
  named = uvec2(placed + 1u, uint(gl_VertexID));
#endif
}
