// What the gallery shows: read from docs/gallery.json, written as docs/gallery.md.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct GalleryPicture {
  std::string name;      // of the file, without folder and ending
  std::string mission;   // path of the script
  std::vector<std::string> set;  // key=value, as after --set; those of its section first
  int frame = 0;                 // of the flight
  std::string channel = "colour";  // see channel_picture.h
  std::string caption;
};
struct GallerySection {
  std::string title, text;
  std::string mission;           // of pictures that name none
  std::vector<std::string> set;  // of all its pictures
  std::vector<GalleryPicture> pictures;
};
struct Gallery {
  std::vector<GallerySection> sections;
};

// Throws InputError: no JSON, a member that is missing or of another kind.
Gallery load_gallery(const std::string& path);

// The page, in Markdown: each picture with its caption, its mission and the keys that it changes.
std::string gallery_page(const Gallery& gallery);

}  // namespace rubble
