// A schema: one entry for every key that a user can write, bound to the member it fills.
//
// The loader, the checker, --set, the JSON of a resolved scenario, the JSON Schema and the
// reference in docs/reference/missions.md are all made from these entries, so they cannot drift apart.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "scripting/trajectory/trajectory.h"
#include "scripting/values/value.h"

namespace rubble {

struct Choice {  // an enumeration
  std::vector<std::string> names;  // what may be written, by index
  std::function<int()> get;        // index of a name
  std::function<void(int)> set;
};
struct Negated {  // the member is the opposite of what the user writes
  bool* member;   // opposite of what is written
};
struct StringOrList {  // "a" or {"a", "b"}
  std::vector<std::string>* member;  // one or several words
};
struct WordOrFile {  // one of the words, or { key = "FILE" }; with a word, the file is empty
  std::vector<std::string> words;  // what may be written
  int* word;                       // index of the word
  std::string key;                 // of the table with the file
  std::string* file;               // path as written
};
// A point, or a place in a void that { find_void = { ... } } names (see rubble.find_void). One of
// `point` and `maybe` is given; when the place is set, they are not used.
struct PlaceSlot {
  Vec3* point;                        // unit: m
  std::optional<Vec3>* maybe;         // unit: m
  std::optional<VoidPlace>* in_void;  // set: the others are not used
};
using NumberPair = std::array<double, 2>;
class Schema;
struct TableList {  // a list within an item of a list: each table of it has a schema of its own
  std::function<std::size_t()> size;
  std::function<void(std::size_t)> resize;      // new items have the defaults
  std::function<Schema(std::size_t)> make_item;  // its keys start at the item
};
struct NamedTables {  // { name = { ... }, ... }: each table has a schema of its own
  std::function<std::vector<std::string>()> names;  // in order
  std::function<void(const std::vector<std::string>&)> reset;  // to items of these names, with defaults
  std::function<Schema(std::size_t)> make_item;  // its keys start at the item
  std::string example;  // of a name, for documents
};
using TextMap = std::vector<std::pair<std::string, std::string>>;  // { name = "text", ... }
using NumberMap = std::vector<std::pair<std::string, double>>;     // { name = 1.5, ... }

// Where a key's value lives, and with that its type. Value*: any table, taken as it is.
using Slot = std::variant<bool*, Negated, int*, std::int64_t*, std::uint64_t*, double*,
                          std::optional<double>*, std::string*, std::optional<std::string>*, Choice,
                          Vec3*, std::optional<Vec3>*, NumberPair*, std::optional<NumberPair>*,
                          std::vector<std::string>*, StringOrList, WordOrFile, Value*, TableList, NamedTables,
                           PlaceSlot, std::vector<double>*, TextMap*, NumberMap*>;

struct Range {
  double min = -std::numeric_limits<double>::infinity();  // allowed, unless above_min
  double max = std::numeric_limits<double>::infinity();   // allowed
  bool above_min = false;  // min itself is not allowed
};

enum class KeyKind { value, group, list };

struct Key {
  std::string path;  // "pile.layers"; of a list's items "pile.mix[].weight"
  KeyKind kind = KeyKind::value;  // how it is written
  std::string doc_text;   // one line, a whole sentence
  std::string unit_text;  // empty: none
  Range range;            // of numbers; unit: unit_text
  bool required = false;  // true: a mistake without it
  bool implies_on = false;  // of a group with a switch `on`: a table that does not name it means true
  std::function<Slot(std::size_t)> bind;    // of a value; the index is that of the list's item
  std::function<std::size_t()> size;        // of a list
  std::function<void(std::size_t)> resize;  // of a list; new items have the defaults

  Key& unit(std::string text) { return unit_text = std::move(text), *this; }
  Key& between(double min, double max) { return range = {min, max, false}, *this; }
  Key& above(double min, double max = std::numeric_limits<double>::infinity()) {
    return range = {min, max, true}, *this;
  }
  Key& must() { return required = true, *this; }
  Key& on_when_written() { return implies_on = true, *this; }

  std::string name() const;    // its last word: "layers"
  std::string parent() const;  // "pile", "pile.mix[]", "" at the top
};

// Another name for a key, at the top level only.
struct Alias {
  std::string name;      // as users write it
  std::string path;      // a key, or one component of a vector such as "light.position.x"
  bool negated = false;  // the alias says the opposite
};

// The keys hold references into one object, which must outlive them.
class Schema {
 public:
  Key& group(std::string path, std::string doc);
  template <typename T>
  Key& value(std::string path, T& member, std::string doc) {
    return add(std::move(path), std::move(doc), [&member](std::size_t) { return Slot(&member); });
  }
  template <typename E>
  static Slot choice_slot(E& member, std::vector<std::string> names) {
    return Choice{std::move(names), [&member] { return static_cast<int>(member); },
                  [&member](int i) { member = static_cast<E>(i); }};
  }
  template <typename E>
  Key& choice(std::string path, E& member, std::vector<std::string> names, std::string doc) {
    return add(std::move(path), std::move(doc), [&member, names = std::move(names)](std::size_t) {
      return choice_slot(member, names);
    });
  }
  template <typename T>
  Key& list(std::string path, std::vector<T>& member, std::string doc) {
    Key& key = group(std::move(path), std::move(doc));
    key.kind = KeyKind::list;
    key.size = [&member] { return member.size(); };
    key.resize = [&member](std::size_t n) { member.clear(), member.resize(n); };
    return key;
  }
  template <typename T, typename M>
  Key& item(std::string path, std::vector<T>& list, M T::*member, std::string doc) {
    return add(std::move(path), std::move(doc),
               [&list, member](std::size_t i) { return Slot(&(list[i].*member)); });
  }
  // make: the schema of one of its tables.
  template <typename T>
  static Slot table_list(std::vector<T>& member, Schema (*make)(T&)) {
    return TableList{[&member] { return member.size(); },
                     [&member](std::size_t n) { member.clear(), member.resize(n); },
                     [&member, make](std::size_t i) { return make(member[i]); }};
  }
  // name: the member of an item that keeps its name.
  template <typename T>
  static Slot named_tables(std::vector<T>& member, std::string T::*name, std::string example,
                           Schema (*make)(T&)) {
    return NamedTables{[&member, name] {
                         std::vector<std::string> names;
                         for (const T& item : member) names.push_back(item.*name);
                         return names;
                       },
                       [&member, name](const std::vector<std::string>& names) {
                         member.clear(), member.resize(names.size());
                         for (std::size_t i = 0; i < names.size(); ++i) member[i].*name = names[i];
                       },
                       [&member, make](std::size_t i) { return make(member[i]); },
                       std::move(example)};
  }
  Key& add(std::string path, std::string doc, std::function<Slot(std::size_t)> bind);
  void alias(std::string name, std::string path, bool negated = false);

  const std::vector<Key>& keys() const { return keys_; }
  const std::vector<Alias>& aliases() const { return aliases_; }
  const Key* find(const std::string& path) const;
  std::vector<const Key*> children(const std::string& parent) const;  // in order

 private:
  std::vector<Key> keys_;
  std::vector<Alias> aliases_;
};

// "an integer from 0 to 1000", "one of \"layers\", \"planes\"", ...
std::string describe_expected(const Key& key);
// Its value now, as the user would write it.
Value read_slot(const Slot& slot);
// Stores a value of the right type and range, or says what is wrong (then nothing is stored).
std::optional<Diagnostic> write_slot(const Key& key, const Slot& slot, const Value& value,
                                     const std::string& shown_path);
// The mistakes of what the members hold now: ranges and finiteness of every key.
std::vector<Diagnostic> check_ranges(const Schema& schema);

// Fills the members from a table. Adds every mistake; keys come as paths, without file and line. written: the paths of all keys
// that the table has are added.
void read_table(const Schema& schema, const Value& table, std::vector<Diagnostic>& mistakes,
                std::vector<std::string>* written = nullptr);

// Applies "pile.layers=3" or "numlayers=3" (an item of a list: "trajectory.waypoints[2].t=4"; a
// component: "light.position.z=9"; a vector: "1,2,3", "{1, 2, 3}"). Mistakes name "--set" as their file.
void apply_override(const Schema& schema, const std::string& text,
                    std::vector<Diagnostic>& mistakes);

// The name nearest to what was written, if near enough to be meant; empty otherwise.
std::string nearest_name(const std::string& written, const std::vector<std::string>& names);

// Between schemas, values and JSON text. The JSON library stays behind these functions.

// What a schema's members hold now, in the schema's order, indented by two spaces.
std::string members_to_json(const Schema& schema);

std::string slot_to_json(const Slot& slot);  // lists as arrays, maps and named fields as objects

// Throws InputError with the line when `text` is not JSON.
Value parse_json(const std::string& text, const std::string& file);

}  // namespace rubble
