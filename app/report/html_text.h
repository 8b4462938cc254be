// Pieces of web pages that need no server and no network.
#pragma once

#include <string>
#include <string_view>

namespace rubble {

// What is text in a page, and in an attribute in double quotes.
std::string html_escape(std::string_view text);
// A path as an address relative to the page.
std::string url_escape(std::string_view path);
std::string base64(std::string_view bytes);

// A page of our looks; body, script: as they are; title: text.
std::string make_page(const std::string& title, const std::string& body, const std::string& script);

}  // namespace rubble
