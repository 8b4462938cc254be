// How much slower the program may be under a sanitizer: for tests that wait for it by the clock.
#pragma once

namespace rubble::testing {

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr int kSlowdown = 8;
#else
constexpr int kSlowdown = 1;
#endif

}  // namespace rubble::testing
