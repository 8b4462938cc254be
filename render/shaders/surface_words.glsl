// surface_model.glsl, tone.glsl and fog_depth.glsl in GLSL.
#define FN
#define Real float
#define Real3 vec3
#define Mask bool
#define real float
#define real3 vec3
#define select(m, a, b) ((m) ? (a) : (b))
#define both(m, n) ((m) && (n))
#define either(m, n) ((m) || (n))
#define inverse_sqrt inversesqrt
#include "surface_model.glsl"
#include "tone.glsl"
#include "fog_depth.glsl"
