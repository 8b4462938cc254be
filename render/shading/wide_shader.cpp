// Compiled once for each instruction set, see CMakeLists.txt.
#include "render/shading/air_trace.h"
#include "render/shading/shade.h"

#define RUBBLE_TEXT_OF(x) #x
#define RUBBLE_TEXT(x) RUBBLE_TEXT_OF(x)

namespace rubble::RUBBLE_ISA {

extern const WideShader kWideShader;
const WideShader kWideShader{RUBBLE_TEXT(RUBBLE_ISA), shade, find_contacts, trace_air};

}  // namespace rubble::RUBBLE_ISA
