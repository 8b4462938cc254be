#include "bench/gallery_list.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/base/error.h"

namespace rubble {
namespace {

using Json = nlohmann::json;

GalleryPicture read_picture(const Json& json, const Json& section) {
  GalleryPicture picture;
  picture.name = json.at("name");
  picture.mission = json.value("mission", section.value("mission", std::string()));
  picture.frame = json.value("frame", 0);
  picture.channel = json.value("channel", std::string("colour"));
  picture.caption = json.at("caption");
  for (const Json& change : section.value("set", Json::array())) picture.set.push_back(change);
  for (const Json& change : json.value("set", Json::array())) picture.set.push_back(change);
  return picture;
}

std::string command_of(const GalleryPicture& picture) {
  std::string text = "rubble run " + picture.mission;
  for (const std::string& change : picture.set) text += " --set '" + change + "'";
  return text;
}

}  // namespace

Gallery load_gallery(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError({path, 0, "", "cannot be read", "a list of pictures", "", ""});
  Gallery gallery;
  try {
    const Json list = Json::parse(file);
    for (const Json& json : list.at("sections")) {
      GallerySection section{json.at("title"), json.value("text", std::string()), {}};
      for (const Json& picture : json.at("pictures"))
        section.pictures.push_back(read_picture(picture, json));
      gallery.sections.push_back(section);
    }
  } catch (const Json::exception& error) {
    throw InputError({path, 0, "", error.what(), "the members that bench/gallery_list.h names", "", ""});
  }
  return gallery;
}

std::string gallery_page(const Gallery& gallery) {
  std::string page =
      "# Gallery\n\n`make gallery` draws every picture here from the bundled missions and writes this\n"
      "page; [gallery.json](gallery.json) lists them. Below each is the command whose recording holds "
      "it.\n";
  for (const GallerySection& section : gallery.sections) {
    page += "\n## " + section.title + "\n";
    if (!section.text.empty()) page += "\n" + section.text + "\n";
    for (const GalleryPicture& picture : section.pictures)
      page += "\n![" + picture.name + "](pictures/gallery/" + picture.name + ".jpg)\n\n" +
              picture.caption + "\n\n    " + command_of(picture) + "\n";
  }
  return page;
}

}  // namespace rubble
