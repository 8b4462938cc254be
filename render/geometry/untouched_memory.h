// Memory for large tables of which only parts are ever written: it is zero, and takes no room until it is written.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace rubble {

// `bytes` that are zero; std::free() gives them back. Null: memory is short.
void* allocate_untouched(std::size_t bytes);

// For a std::vector that gets its size once: its elements are zero bytes, which must be a value of T, until they are set.
template <typename T>
struct UntouchedMemory {
  using value_type = T;
  static_assert(std::is_trivially_copyable_v<T>);

  UntouchedMemory() = default;
  template <typename U>
  UntouchedMemory(const UntouchedMemory<U>&) {}

  T* allocate(std::size_t count) {
    void* const found = count <= std::size_t(-1) / sizeof(T) ? allocate_untouched(count * sizeof(T)) : nullptr;
    if (!found) throw std::bad_alloc();
    return static_cast<T*>(found);
  }
  void deallocate(T* place, std::size_t) { std::free(place); }
  template <typename U>
  void construct(U*) {}  // zero already
  template <typename U, typename... From>
  void construct(U* place, From&&... from) {
    ::new (static_cast<void*>(place)) U(std::forward<From>(from)...);
  }

  friend bool operator==(const UntouchedMemory&, const UntouchedMemory&) { return true; }
  friend bool operator!=(const UntouchedMemory&, const UntouchedMemory&) { return false; }
};

template <typename T>
using UntouchedTable = std::vector<T, UntouchedMemory<T>>;

}  // namespace rubble
