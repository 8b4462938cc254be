#include "io/base/xml_document.h"

#include <expat.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "kernel/base/error.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr std::size_t kDeepest = 200;  // elements within each other; destructors recurse

// Of Windows-1252 from 0x80 to 0x9F; the rest is Latin-1. -1: not assigned.
constexpr int kWindows1252[32] = {0x20AC, -1,     0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                  0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, -1,     0x017D, -1,
                                  -1,     0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                  0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, -1,     0x017E, 0x0178};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : char(c); });
  return text;
}

// Of single bytes, beside those that Expat knows (UTF-8, UTF-16, ISO-8859-1, US-ASCII).
int XMLCALL know_encoding(void*, const XML_Char* name, XML_Encoding* encoding) {
  const std::string called = lower(name);
  const bool windows = called == "windows-1252" || called == "cp1252";
  if (!windows && called != "latin1" && called != "latin-1" && called != "iso8859-1") return XML_STATUS_ERROR;
  for (int i = 0; i < 256; ++i) encoding->map[i] = windows && i >= 0x80 && i < 0xA0 ? kWindows1252[i - 0x80] : i;
  return XML_STATUS_OK;
}

bool is_utf16(const std::string& text) {
  return text.size() > 1 && ((text[0] == '\xFF' && text[1] == '\xFE') || (text[0] == '\xFE' && text[1] == '\xFF'));
}

// Comments say nothing to a reader. XML forbids "--" in them, and people write it. Lines stay.
std::string blank_comments(std::string text) {
  std::size_t at = 0;
  const auto skip = [&](const char* end) {
    const std::size_t found = text.find(end, at);
    return found == std::string::npos ? text.size() : found;
  };
  while ((at = text.find('<', at)) != std::string::npos) {
    if (text.compare(at, 9, "<![CDATA[") == 0) {
      at = skip("]]>");
    } else if (text.compare(at, 2, "<?") == 0) {
      at = skip("?>");
    } else if (text.compare(at, 4, "<!--") == 0) {
      at += 4;
      const std::size_t end = skip("-->");
      for (; at < end; ++at)
        if (text[at] != '\n' && text[at] != '\r') text[at] = ' ';
    } else {
      ++at;
    }
  }
  return text;
}

// Of the declaration, in lower case; empty: none is given.
std::string declared_encoding(const std::string& text) {
  if (text.compare(0, 5, "<?xml") != 0) return "";
  const std::string declaration = text.substr(0, text.find("?>"));
  const std::size_t key = declaration.find("encoding");
  if (key == std::string::npos) return "";
  const std::size_t open = declaration.find_first_of("\"'", key);
  if (open == std::string::npos) return "";
  const std::size_t close = declaration.find(declaration[open], open + 1);
  if (close == std::string::npos) return "";
  return lower(declaration.substr(open + 1, close - open - 1));
}

class Parser {
 public:
  Parser(std::string text, const std::string& path) : path_(path) {
    if (!is_utf16(text)) {
      const std::size_t start = text.find_first_not_of(" \t\r\n");
      skipped_ = int(std::count(text.begin(), text.begin() + std::ptrdiff_t(std::min(start, text.size())), '\n'));
      text = blank_comments(text.substr(std::min(start, text.size())));
      while (!text.empty() && text.back() == '\0') text.pop_back();
    }
    parser_ = XML_ParserCreate(choose_encoding(text));
    if (!parser_) throw RunError("no memory for reading " + path);
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, begin, end);
    XML_SetCharacterDataHandler(parser_, add_text);
    XML_SetUnknownEncodingHandler(parser_, know_encoding, nullptr);
    XML_SetExternalEntityRefHandler(parser_, refuse_external);
    text_ = std::move(text);
  }
  ~Parser() { XML_ParserFree(parser_); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  XmlDocument parse() {
    if (text_.size() > std::size_t(std::numeric_limits<int>::max()))
      throw InputError({path_, 0, "", "too large for an XML file", "less than 2 GB", "", ""});
    const bool fine = XML_Parse(parser_, text_.data(), int(text_.size()), 1) == XML_STATUS_OK;
    if (too_deep_) fail("nested too deeply", "at most " + std::to_string(kDeepest) + " elements within each other", "");
    if (external_) fail("an entity outside of the file is not read", "a file that holds all of it", "");
    if (!fine) fail("not well-formed XML", "an XML document", XML_ErrorString(XML_GetErrorCode(parser_)));
    return std::move(document_);
  }

 private:
  // Null: what the file says. Files that say nothing, or UTF-8, and are something else come from old editors.
  const char* choose_encoding(const std::string& text) {
    if (is_utf16(text)) return nullptr;
    const std::string declared = declared_encoding(text);
    const std::size_t at = find_invalid_utf8(text);
    if (at == std::string::npos || !(declared.empty() || declared == "utf-8" || declared == "utf8")) return nullptr;
    const auto line = 1 + skipped_ + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
    document_.warnings.push_back(path_ + ":" + std::to_string(line) +
                                 ": not UTF-8, although the file names no other encoding: read as ISO-8859-1");
    return "ISO-8859-1";
  }

  int line() const { return int(XML_GetCurrentLineNumber(parser_)) + skipped_; }

  [[noreturn]] void fail(const std::string& message, const std::string& expected, const std::string& found) const {
    throw InputError({path_, line(), "", message, expected, found, ""});
  }

  static void XMLCALL begin(void* self, const XML_Char* name, const XML_Char** attributes) {
    static_cast<Parser*>(self)->begin_element(name, attributes);
  }
  static void XMLCALL end(void* self, const XML_Char*) {
    auto& open = static_cast<Parser*>(self)->open_;
    if (!open.empty()) open.pop_back();
  }
  static void XMLCALL add_text(void* self, const XML_Char* text, int length) {
    auto& open = static_cast<Parser*>(self)->open_;
    if (!open.empty()) open.back()->text.append(text, std::size_t(length));
  }
  static int XMLCALL refuse_external(XML_Parser parser, const XML_Char*, const XML_Char*, const XML_Char*,
                                     const XML_Char*) {
    static_cast<Parser*>(XML_GetUserData(parser))->external_ = true;
    return XML_STATUS_ERROR;
  }

  void begin_element(const XML_Char* name, const XML_Char** attributes) {
    if (open_.size() >= kDeepest) {
      too_deep_ = true;
      XML_StopParser(parser_, XML_FALSE);
      return;
    }
    XmlElement& element = open_.empty() ? document_.root : open_.back()->children.emplace_back();
    element.name = name;
    element.line = line();
    for (; attributes[0]; attributes += 2) element.attributes.emplace_back(attributes[0], attributes[1]);
    open_.push_back(&element);  // siblings are added after it has ended
  }

  std::string path_, text_;
  XML_Parser parser_ = nullptr;
  XmlDocument document_;
  std::vector<XmlElement*> open_;  // from the root to the one that is read
  int skipped_ = 0;                // lines before the document
  bool too_deep_ = false, external_ = false;
};

}  // namespace

const std::string* XmlElement::find(const std::string& attribute) const {
  for (const auto& [name_of, value] : attributes)
    if (name_of == attribute) return &value;
  return nullptr;
}

const XmlElement* XmlElement::child(const std::string& child_name) const {
  for (const XmlElement& element : children)
    if (element.name == child_name) return &element;
  return nullptr;
}

XmlDocument parse_xml(const std::string& text, const std::string& path) { return Parser(text, path).parse(); }

}  // namespace rubble
