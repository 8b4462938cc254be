#include "io/mesh_formats/collada_repair.h"

#include <algorithm>

#include "io/import/text_scan.h"
#include "io/import/xml_scan.h"

namespace rubble {
namespace {

// Without <init_from/> and <init_from> </init_from>, which end assimp by an assertion: an image without a name is only
// refused where it is used.
std::string without_empty_names(std::string xml) {
  const std::string name = "<init_from", close = "</init_from>";
  for (std::size_t at = xml.find(name); at != std::string::npos; at = xml.find(name, at)) {
    const std::size_t tag = end_of_markup(xml, at);
    const std::size_t content = xml.find_first_not_of(" \t\r\n", tag);
    if (tag >= 2 && xml[tag - 2] == '/')
      xml.erase(at, tag - at);
    else if (content != std::string::npos && xml.compare(content, close.size(), close) == 0)
      xml.erase(at, content + close.size() - at);
    else
      at = tag;
  }
  return xml;
}

}  // namespace

std::string repair_collada(const std::string& xml) {
  if (xml.find('\0') != std::string::npos) return xml;  // UTF-16: assimp's own conversion reads it
  std::string out;
  out.reserve(xml.size());
  for (std::size_t at = 0; at < xml.size();) {
    if (xml[at] == '<') {
      const std::size_t end = end_of_markup(xml, at);
      out.append(xml, at, end - at);
      at = end;
      continue;
    }
    const std::size_t end = std::min(xml.find('<', at), xml.size());
    const std::string_view content = trimmed(std::string_view(xml).substr(at, end - at));
    if (content.empty()) out.append(xml, at, end - at);  // between elements: lines keep their numbers
    out += content;
    at = end;
  }
  return without_empty_names(std::move(out));
}

std::string without_looks(const std::string& collada) {
  std::string out = collada;
  for (const std::string library : {"library_images", "library_effects", "library_materials"})
    for (std::size_t begin = out.find("<" + library); begin != std::string::npos; begin = out.find("<" + library, begin)) {
      const std::string close = "</" + library + ">";
      const std::size_t tag = end_of_markup(out, begin), end = out.find(close, begin);
      const bool empty = tag >= 2 && out[tag - 2] == '/';
      out.erase(begin, (empty || end == std::string::npos ? tag : end + close.size()) - begin);
    }
  return out;
}

std::optional<FileUp> find_up_axis(const std::string& xml) {
  const std::size_t at = xml.find("<up_axis>");
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + 9, end = std::min(xml.find('<', begin), xml.size());
  const std::string_view axis = trimmed(std::string_view(xml).substr(begin, end - begin));
  if (axis == "X_UP") return FileUp::x;
  if (axis == "Y_UP") return FileUp::y;
  return axis == "Z_UP" ? std::optional(FileUp::z) : std::nullopt;
}

}  // namespace rubble
