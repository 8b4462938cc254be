#include "app/report/html_text.h"

#include <cctype>
#include <cstdint>

namespace rubble {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 1.5rem auto; max-width: 80rem; padding: 0 1rem;
  color: #1b1b1b; background: #fcfcfb; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
h3 { font-size: 1rem; margin: 1.2rem 0 .4rem; } p { max-width: 60rem; }
.plots, .pictures { display: flex; flex-wrap: wrap; gap: .8rem; }
figure { margin: 0; content-visibility: auto; } figcaption { font-size: .8rem; max-width: 20rem; overflow-wrap: anywhere; }
small { display: block; font-size: .75rem; opacity: .75; }
svg text { font: 11px system-ui, sans-serif; fill: currentColor; }
svg .axis { stroke: currentColor; opacity: .5; } svg .bar { fill: #3b6ea5; }
svg .dot { fill: #3b6ea5; fill-opacity: .7; } svg .dot.bad { fill: #c0392b; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .5rem; border-bottom: 1px solid #8884; text-align: right; white-space: nowrap; }
th { position: sticky; top: 0; background: #eceae6; }
.runs th { cursor: pointer; } .means td, .means th { vertical-align: top; }
.means td:first-child, .means th:first-child { text-align: left; } td.text, th.text { text-align: left; } tr.bad td { color: #c0392b; }
@media (prefers-color-scheme: dark) {
  body { color: #e8e6e3; background: #1b1c1d; } th { background: #2c2e30; } a { color: #8ab4f8; } }
)";

}  // namespace

std::string html_escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string url_escape(std::string_view path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '/' || c == '-' || c == '_' || c == '.' || c == '~') {
      out += c;
    } else {
      out += '%';
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    }
  }
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kLetters[three >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string make_page(const std::string& title, const std::string& body, const std::string& script) {
  // "</script>" within a script would end it.
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
         html_escape(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n" + body +
         "<script>\n" + script + "</script>\n</body>\n</html>\n";
}

}  // namespace rubble
