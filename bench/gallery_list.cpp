#include "bench/gallery_list.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/base/error.h"

namespace rubble {
namespace {

using Json = nlohmann::json;

std::vector<std::string> read_set(const Json& json) {
  return json.value("set", std::vector<std::string>());
}

GalleryPicture read_picture(const Json& json, const Json& section) {
  GalleryPicture picture;
  picture.name = json.at("name");
  picture.mission = json.value("mission", section.value("mission", std::string()));
  picture.frame = json.value("frame", 0);
  picture.channel = json.value("channel", std::string("colour"));
  picture.caption = json.at("caption");
  picture.set = read_set(section);
  for (const std::string& change : read_set(json)) picture.set.push_back(change);
  return picture;
}

// " `mission` `key=value` ..."
std::string code_of(const std::string& mission, const std::vector<std::string>& set) {
  std::string text;
  if (!mission.empty()) text += " `" + mission + "`";
  for (const std::string& change : set) text += " `" + change + "`";
  return text;
}

// " (channel `depth`, frame 3)": of the pictures of the run.
std::string choice_of(const GalleryPicture& picture) {
  std::string text;
  if (picture.channel != GalleryPicture().channel) text = "channel `" + picture.channel + "`";
  if (picture.frame != 0) text += (text.empty() ? "frame " : ", frame ") + std::to_string(picture.frame);
  return text.empty() ? "" : " (" + text + ")";
}

std::string page_of(const GallerySection& section) {
  std::string page = "\n## " + section.title + "\n";
  if (!section.text.empty()) page += "\n" + section.text + "\n";
  if (const std::string common = code_of(section.mission, section.set); !common.empty())
    page += "\nAll pictures:" + common + "\n";
  for (const GalleryPicture& picture : section.pictures) {
    const std::vector<std::string> own(picture.set.begin() + static_cast<long>(section.set.size()), picture.set.end());
    page += "\n![" + picture.name + "](pictures/gallery/" + picture.name + ".jpg)\n\n" + picture.caption +
            code_of(picture.mission == section.mission ? "" : picture.mission, own) + choice_of(picture) + "\n";
  }
  return page;
}

}  // namespace

Gallery load_gallery(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError({path, 0, "", "cannot be read", "a list of pictures", "", ""});
  Gallery gallery;
  try {
    const Json list = Json::parse(file);
    for (const Json& json : list.at("sections")) {
      GallerySection section{json.at("title"), json.value("text", std::string()), json.value("mission", std::string()),
                             read_set(json), {}};
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
      "# Gallery\n\n`make pictures` draws these pictures from bundled missions; [gallery.json](gallery.json) lists them.\n"
      "Below each picture are the mission and the keys that it changes, for `--set`. "
      "Unless stated, it is the colour of frame 0:\n\n"
      "    rubble run scripts/collapse/lean_to.lua --set camera.width=720 --set camera.height=540 --set lamp.on=false\n";
  for (const GallerySection& section : gallery.sections) page += page_of(section);
  return page;
}

}  // namespace rubble
