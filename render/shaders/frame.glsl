// What is the same for all pixels of a frame. Mirrors struct FrameBlock in passes/resolve_pass.cpp.
layout(std140) uniform Frame {
  vec4 world_from_optical[3];  // rows
  vec4 lens;                   // 1/fx, 1/fy, cx, cy
  vec4 view;                   // near plane, exposure, width, height
  vec4 light_position;         // world; spot and point
  vec4 light_axis;             // the way the light travels; w: cosine of the cone's edge
  vec4 light_colour;           // klx (directional) or kcd; w: 1 / (inner - outer cosine)
  vec4 lamp_position;          // world
  vec4 lamp_axis;              // the way it looks; w: 1 / (1 - cosine of the half-power angle)
  vec4 lamp_colour;            // kcd
  vec4 fog;                    // extinction 1/m, brightness 0..1
  vec4 fog_ambient;            // mean radiance around the camera, kcd/m2
  vec4 sky_zenith, sky_horizon, sky_glow;  // kcd/m2
  vec4 sun_direction;
  vec4 shadow_rows[24];        // rows of clip_from_world, four for each of six views
  vec4 shadow_texel;           // world size of a texel (directional) or per metre (others)
  vec4 looks[48];              // four for each look: dark + 1/tile, light + bump, accent + gloss,
                               // (layer, dust, variation, log2(texels per m))
};
