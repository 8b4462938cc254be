// What is the same for all pixels of a frame. Mirrors struct FrameBlock in colour/frame_fill.cpp.
layout(std140) uniform Frame {
  vec4 world_from_optical[3];  // rows
  vec4 lens;                   // 1/fx, 1/fy, cx, cy
  vec4 view;                   // near plane, exposure, width, height
  vec4 light_position[4];      // world; spot and point; w: width of a shadow texel (directional)
                               // or of one per metre (others)
  vec4 light_axis[4];          // the way the light travels; w: cosine of the cone's edge; of a directional one
                               // the width of a texel of its second shadow map
  vec4 light_colour[4];        // klx (directional) or kcd; w: 1 / (inner - outer cosine)
  vec4 lamp_position;          // world; w: what its size adds to the square of the distance, m2
  vec4 lamp_axis;              // the way it looks; w: 1 / (1 - cosine of the half-power angle)
  vec4 lamp_colour;            // kcd
  vec4 wetness;                // of surfaces, 0..1; y, z: what shifts the noise of 8 bits, by the number of the image
  vec4 sun_direction;
  vec4 sun_radiance;           // of its disc, kcd/m2
  vec4 skyline;                // colour of what stands far away, kcd/m2
  vec4 ground;                 // middle of the ground's map, 1 / its reach
  vec4 air_low;                // corners of the box in which air weakens the beams; w: extinction of fog at the ground, 1/m
  vec4 air_high;               // w: 1 / the height in which fog thins by e; 0: it does not
  vec4 air_drops;              // extinction of rain and snow, 1/m; y: share of all extinction that beams lose
  vec4 balance;                // white balance of the display image
  vec4 shadow_rows[96];        // rows of clip_from_world, four for each view
  vec4 looks[180];             // four for each look: dark + 1/tile, light + bump, accent + gloss,
                               // (layer, dust, variation, log2(texels per m)); a bump below 0 is a glow
};
