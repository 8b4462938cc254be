// Between RUBBLE_BEGIN_TARGET and RUBBLE_END_TARGET functions are compiled for processors with the named
// instructions, templates included; they may be called only where the processor has these. Headers that
// others use too are included before: what is inline in them must run everywhere.
#pragma once

#define RUBBLE_PRAGMA(text) _Pragma(#text)
#if defined(__clang__)
#define RUBBLE_BEGIN_TARGET(names) \
  RUBBLE_PRAGMA(clang attribute push(__attribute__((target(names))), apply_to = function))
#define RUBBLE_END_TARGET RUBBLE_PRAGMA(clang attribute pop)
#else
#define RUBBLE_BEGIN_TARGET(names) RUBBLE_PRAGMA(GCC push_options) RUBBLE_PRAGMA(GCC target(names))
#define RUBBLE_END_TARGET RUBBLE_PRAGMA(GCC pop_options)
#endif
