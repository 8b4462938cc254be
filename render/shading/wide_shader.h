// The shading of pixels on the processor, compiled for several instruction sets: all give the same
// bits.
#pragma once

#include <string>
#include <vector>

#include "render/shading/air_trace_data.h"
#include "render/shading/shading_data.h"

namespace rubble {

// For the shadows of the lamp, see contact.h.
struct ContactData {
  static constexpr int kLampSteps = 8;

  const float* depth_values = nullptr;   // near / Z
  int width = 0, height = 0;             // of the image
  int half_width = 0, half_height = 0;   // of the grid
  int stride = 0;                        // from row to row of it: a multiple of four
  float near = 0;                        // unit: m
  float fx = 1, fy = 1, cx = 0, cy = 0;  // as Intrinsics
  float lamp[3] = {};                    // in the optical frame; unit: m
  float lamp_radius = 0;                 // unit: m
  float lamp_cosine[16], lamp_sine[16];  // of its spots
  float* lamp_seen = nullptr;            // the grid that is written, as OpennessGrid, not smoothed
};

struct WideShader {
  const char* name;  // of the instruction set
  // Rows [first, last) of blocks of four rows of pixels: of the grid of ShadedPixels.
  void (*shade)(const ShadingData& data, const ShadedPixels& out, int first, int last);
  // Rows [first, last) of the grid; the first is a multiple of four.
  void (*find_contacts)(const ContactData& data, int first, int last);
  // Rows [first, last) of blocks of four rows of rays.
  void (*trace_air)(const AirTraceData& data, int first, int last);
};

// Those that this processor can run, the fastest first. Never empty.
const std::vector<WideShader>& wide_shaders();
// By name; "": the fastest. Throws RunError that names those that there are.
const WideShader& find_wide_shader(const std::string& name);

}  // namespace rubble
