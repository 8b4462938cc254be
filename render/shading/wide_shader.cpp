// Compiled once for each instruction set, see CMakeLists.txt.
#include "render/shading/air_trace.h"
#include "render/shading/shade.h"


namespace rubble::RUBBLE_ISA {

extern const WideShader kWideShader;
const WideShader kWideShader{RUBBLE_NAME_OF_ISA, shade, find_contacts, trace_air};

}  // namespace rubble::RUBBLE_ISA
