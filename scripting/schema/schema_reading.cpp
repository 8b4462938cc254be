// What a mission has, as values of a script.
#include "scripting/schema/slot_kinds.h"

namespace rubble {
namespace {

Value list_of(const std::vector<std::string>& strings) {
  Value list = Value::make_table();
  for (const std::string& s : strings) list.items.push_back(Value::make_text(s));
  return list;
}

// The keys below `pattern` as a table, its groups as tables in it.
Value table_of(const Schema& schema, const std::string& pattern) {
  Value table = Value::make_table();
  for (const Key* key : schema.children(pattern))
    table.set(key->name(), key->kind == KeyKind::value ? read_slot(key->bind(0))
                                                       : table_of(schema, key->path));
  return table;
}

// Nothing, where there are none.
Value table_of(const NamedTables& tables) {
  const std::vector<std::string> names = tables.names();
  Value all = names.empty() ? Value() : Value::make_table();
  for (std::size_t i = 0; i < names.size(); ++i)
    all.set(names[i], table_of(tables.make_item(i), ""));
  return all;
}

template <typename T>
Value read_as(const T& from) {
  if constexpr (std::is_same_v<T, bool*>) {
    return Value::make_boolean(*from);
  } else if constexpr (std::is_same_v<T, Negated>) {
    return Value::make_boolean(!*from.member);
  } else if constexpr (is_integer<T>) {
    return Value::make_integer(static_cast<std::int64_t>(*from));
  } else if constexpr (is_optional<T>) {
    if (!*from) return {};
    auto plain = **from;
    return read_slot(Slot(&plain));
  } else if constexpr (is_number<T>) {
    return Value::make_number(*from);
  } else if constexpr (is_text<T>) {
    return Value::make_text(*from);
  } else if constexpr (is_vector<T>) {
    Value v = Value::make_table();
    for (int i = 0; i < 3; ++i) v.items.push_back(Value::make_number((*from)[i]));
    return v;
  } else if constexpr (is_pair<T>) {
    Value v = Value::make_table();
    for (const double part : *from) v.items.push_back(Value::make_number(part));
    return v;
  } else if constexpr (std::is_same_v<T, Choice>) {
    return Value::make_text(from.names[std::size_t(from.get())]);
  } else if constexpr (std::is_same_v<T, StringOrList>) {
    return list_of(*from.member);
  } else if constexpr (std::is_same_v<T, Value*>) {
    return *from;
  } else if constexpr (std::is_same_v<T, std::vector<double>*>) {
    Value list = Value::make_table();
    for (const double number : *from) list.items.push_back(Value::make_number(number));
    return list;
  } else if constexpr (std::is_same_v<T, PlaceSlot>) {
    if (!*from.in_void) return from.point ? read_slot(Slot(from.point)) : read_slot(Slot(from.maybe));
    VoidPlace place = **from.in_void;
    Value marker = Value::make_table(), members = Value::make_table();
    const Schema schema = void_place_schema(place);
    for (const Key& key : schema.keys()) members.set(key.name(), read_slot(key.bind(0)));
    marker.set("find_void", members);
    return marker;
  } else if constexpr (std::is_same_v<T, WordOrFile>) {
    if (from.file->empty()) return Value::make_text(from.words[std::size_t(*from.word)]);
    Value table = Value::make_table();
    table.set(from.key, Value::make_text(*from.file));
    return table;
  } else if constexpr (std::is_same_v<T, TableList>) {
    Value list = Value::make_table();
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Schema item = from.make_item(i);
      list.items.push_back(Value::make_table());
      for (const Key& key : item.keys())
        if (key.kind == KeyKind::value) list.items.back().set(key.name(), read_slot(key.bind(0)));
    }
    return list;
  } else if constexpr (std::is_same_v<T, NamedTables>) {
    return table_of(from);
  } else if constexpr (std::is_same_v<T, TextMap*>) {
    Value table = Value::make_table();
    for (const auto& [name, text] : *from) table.set(name, Value::make_text(text));
    return table;
  } else if constexpr (std::is_same_v<T, NumberMap*>) {
    Value table = Value::make_table();
    for (const auto& [name, number] : *from) table.set(name, Value::make_number(number));
    return table;
  } else {
    return list_of(*from);
  }
}

}  // namespace

Schema void_place_schema(VoidPlace& place) {
  Schema k;
  k.value("radius", place.radius, "").between(0.02, 10);
  k.value("rank", place.rank, "").between(1, 1e6);
  k.choice("by", place.order, {"volume", "depth"}, "");
  k.choice("place", place.point, {"entrance", "approach", "deepest", "widest"}, "");
  k.value("distance", place.distance, "").between(0, 100);
  k.value("outside_radius", place.outside_radius, "").between(0.2, 10);
  return k;
}

Value read_slot(const Slot& slot) {
  return std::visit([](const auto& from) { return read_as(from); }, slot);
}

}  // namespace rubble
