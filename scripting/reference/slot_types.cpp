#include "scripting/reference/slot_types.h"

namespace rubble {
namespace {

std::string words_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : "|\"") + name + "\"";
  return text;
}

struct SlotTypes {
  SlotType operator()(bool*) const { return {"boolean", "boolean"}; }
  SlotType operator()(const Negated&) const { return {"boolean", "boolean"}; }
  SlotType operator()(int*) const { return {"integer", "integer"}; }
  SlotType operator()(std::int64_t*) const { return {"integer", "integer"}; }
  SlotType operator()(std::uint64_t*) const { return {"integer", "integer"}; }
  SlotType operator()(double*) const { return {"number", "number"}; }
  SlotType operator()(std::optional<double>*) const { return {"number", "number"}; }
  SlotType operator()(std::string*) const { return {"string", "string"}; }
  SlotType operator()(std::optional<std::string>*) const { return {"string", "string"}; }
  SlotType operator()(const Choice& slot) const { return {"choice", words_of(slot.names)}; }
  SlotType operator()(const WordOrFile& slot) const { return {"choice", words_of(slot.words) + "|{" + slot.key + ": string}"}; }
  SlotType operator()(Vec3*) const { return {"vector", "rubble.Vector"}; }
  SlotType operator()(std::optional<Vec3>*) const { return {"vector", "rubble.Vector"}; }
  SlotType operator()(const PlaceSlot&) const { return {"vector or place", "rubble.Vector|table"}; }
  SlotType operator()(NumberPair*) const { return {"pair", "rubble.Range"}; }
  SlotType operator()(std::optional<NumberPair>*) const { return {"pair", "rubble.Range"}; }
  SlotType operator()(std::vector<std::string>*) const { return {"strings", "string[]"}; }
  SlotType operator()(const StringOrList&) const { return {"strings", "string|string[]"}; }
  SlotType operator()(std::vector<double>*) const { return {"numbers", "number[]"}; }
  SlotType operator()(Value*) const { return {"table", "table"}; }
  SlotType operator()(const TableList&) const { return {"list", "table[]"}; }
  SlotType operator()(const NamedTables&) const { return {"named tables", "table<string, table>"}; }
  SlotType operator()(TextMap*) const { return {"named strings", "table<string, string>"}; }
  SlotType operator()(NumberMap*) const { return {"named numbers", "table<string, number>"}; }
};

}  // namespace

SlotType slot_type(const Slot& slot) { return std::visit(SlotTypes{}, slot); }

}  // namespace rubble
