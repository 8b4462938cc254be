#include "render/geometry/untouched_memory.h"

#include <algorithm>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace rubble {

void* allocate_untouched(std::size_t bytes) {
  void* const found = std::calloc(std::max<std::size_t>(bytes, 1), 1);
#if defined(__linux__)
  // A page of 2 MiB would be there as a whole for a byte of it. What fails costs room alone.
  const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE)), begin = reinterpret_cast<std::uintptr_t>(found);
  const std::uintptr_t first = (begin + page - 1) / page * page, last = (begin + bytes) / page * page;
  if (found && first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_NOHUGEPAGE);
#endif
  return found;
}

}  // namespace rubble
