#include "io/import/xml_scan.h"

#include <algorithm>

#include "io/import/text_scan.h"

namespace rubble {
namespace {

// Characters beyond ASCII stay as they are written: names need no more.
std::string decode_entities(std::string_view text) {
  static constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto found = std::find_if(std::begin(kEntities), std::end(kEntities),
                                    [&](const auto& e) { return text.substr(i, e.first.size()) == e.first; });
    if (found == std::end(kEntities)) {
      out += text[i++];
    } else {
      out += found->second;
      i += found->first.size();
    }
  }
  return out;
}

}  // namespace

std::size_t end_of_markup(std::string_view xml, std::size_t at) {
  const auto ends = [&](std::string_view begin, std::string_view end) -> std::size_t {
    if (xml.substr(at, begin.size()) != begin) return 0;
    const std::size_t found = xml.find(end, at + begin.size());
    return found == std::string_view::npos ? xml.size() : found + end.size();
  };
  if (const std::size_t end = ends("<!--", "-->")) return end;
  if (const std::size_t end = ends("<![CDATA[", "]]>")) return end;
  if (const std::size_t end = ends("<?", "?>")) return end;
  char quote = 0;
  for (std::size_t i = at; i < xml.size(); ++i) {
    const char c = xml[i];
    if (quote) quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'') quote = c;
    else if (c == '>') return i + 1;
  }
  return xml.size();
}

bool XmlScanner::next() {
  for (;;) {
    const std::size_t begin = rest_.find('<');
    if (begin == std::string_view::npos) return false;
    const std::size_t end = end_of_markup(rest_, begin);
    std::string_view tag = rest_.substr(begin, end - begin);
    at_ = std::size_t(rest_.data() - all_.data()) + begin;
    rest_.remove_prefix(end);
    if (tag.size() < 3 || tag[1] == '!' || tag[1] == '?') continue;
    if (tag.back() != '>') return false;
    tag = tag.substr(1, tag.size() - 2);
    closes_ = tag[0] == '/';
    if (closes_) tag.remove_prefix(1);
    empty_ = !tag.empty() && tag.back() == '/';
    if (empty_) tag.remove_suffix(1);
    name_ = take_word(tag);
    read_attributes(tag);
    return true;
  }
}

void XmlScanner::read_attributes(std::string_view tag) {
  attributes_.clear();
  for (std::size_t equals = tag.find('='); equals != std::string_view::npos; equals = tag.find('=')) {
    const std::string_view name = trimmed(tag.substr(0, equals));
    tag.remove_prefix(equals + 1);
    tag.remove_prefix(std::min(tag.size(), tag.find_first_not_of(" \t\r\n")));
    if (tag.empty() || (tag[0] != '"' && tag[0] != '\'')) return;
    const std::size_t end = tag.find(tag[0], 1);
    if (end == std::string_view::npos) return;
    attributes_.emplace_back(name, tag.substr(1, end - 1));
    tag.remove_prefix(end + 1);
  }
}

std::string XmlScanner::attribute(std::string_view name) const {
  for (const auto& [key, value] : attributes_)
    if (key == name) return decode_entities(value);
  return {};
}

int XmlScanner::line() const { return 1 + int(std::count(all_.begin(), all_.begin() + std::ptrdiff_t(at_), '\n')); }

}  // namespace rubble
