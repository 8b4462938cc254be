// Blocks of 4 x 4 pixels one beside the other, in rows of 256, but for the first: two triangles each. size: of the image.
uniform ivec2 size;

void main() {
  int number = gl_InstanceID + 1;
  // (0, 0), (1, 0), (0, 1); (0, 1), (1, 0), (1, 1)
  int of_both = gl_VertexID == 5 ? 3 : gl_VertexID % 3 == 0 && gl_VertexID > 0 ? 2 : gl_VertexID == 4 ? 1 : gl_VertexID;
  ivec2 corner = ivec2(of_both & 1, of_both >> 1);
  ivec2 at = (ivec2(number & 255, number >> 8) + corner) * 4;
  gl_Position = vec4(vec2(at) * 2.0 / vec2(size) - 1.0, 0.0, 1.0);
}
