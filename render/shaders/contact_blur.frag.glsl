// The mean of 4 by 4 texels, which is the period of the pattern in contact.frag.glsl.
uniform sampler2D contact;

layout(location = 0) out float openness;

void main() {
  vec2 texel = 1.0 / vec2(textureSize(contact, 0));
  vec2 at = gl_FragCoord.xy * texel;
  openness = 0.25 * (texture(contact, at + texel * vec2(-0.5, -0.5)).x +
                     texture(contact, at + texel * vec2(1.5, -0.5)).x +
                     texture(contact, at + texel * vec2(-0.5, 1.5)).x +
                     texture(contact, at + texel * vec2(1.5, 1.5)).x);
}
