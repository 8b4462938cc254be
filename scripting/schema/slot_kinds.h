// Kinds of slots that are stored, read and described alike. Not for use outside scripting/schema.
#pragma once

#include <type_traits>

#include "scripting/schema/schema.h"

namespace rubble {

template <typename T, typename... Ts>
constexpr bool is_any = (std::is_same_v<T, Ts> || ...);

template <typename T>
constexpr bool is_integer = is_any<T, int*, std::int64_t*, std::uint64_t*>;
template <typename T>
constexpr bool is_number = is_any<T, double*, std::optional<double>*>;
template <typename T>
constexpr bool is_vector = is_any<T, Vec3*, std::optional<Vec3>*>;
template <typename T>
constexpr bool is_pair = is_any<T, NumberPair*, std::optional<NumberPair>*>;
template <typename T>
constexpr bool is_text = is_any<T, std::string*, std::optional<std::string>*>;
template <typename T>
constexpr bool is_optional = is_any<T, std::optional<double>*, std::optional<std::string>*,
                                    std::optional<Vec3>*, std::optional<NumberPair>*>;

// The members of { find_void = { ... } }.
Schema void_place_schema(VoidPlace& place);

}  // namespace rubble
