#include "io/image/picture_importer.h"

#include "io/image/isolated_picture.h"
#include "kernel/base/system/isolated_worker.h"

namespace rubble {
namespace {

enum class Kind : char { rgb_png = 'c', depth_png = 'd', exr = 'x' };

// A letter for the kind, the channels with a line end after each, an empty line, and the path.
std::string make_request(Kind kind, const std::string& path, const std::vector<std::string>& channels = {}) {
  std::string request(1, char(kind));
  for (const std::string& channel : channels) request += channel + "\n";
  return request + "\n" + path;
}

std::string answer_picture(const std::string& request) {
  std::vector<std::string> channels;
  std::size_t at = 1;
  for (std::size_t end; (end = request.find('\n', at)) != at; at = end + 1)
    channels.push_back(request.substr(at, end - at));
  const std::string path = request.substr(at + 1);
  switch (Kind(request[0])) {
    case Kind::rgb_png: return pack_picture(import_rgb_png(path), &RgbImage::rgb);
    case Kind::depth_png: return pack_picture(import_depth_png(path), &DepthImage::values);
    case Kind::exr: break;
  }
  return pack_picture(import_exr(path, channels), &ExrImage::values);
}

}  // namespace

PictureImporter::PictureImporter(const std::string& recording)
    : worker_(std::make_unique<IsolatedWorker>("picture", answer_picture)) {
  worker_->share_folder(recording);
}

PictureImporter::~PictureImporter() = default;

RgbImage PictureImporter::read_rgb_png(const std::string& path) {
  return unpack_picture(worker_->ask(path, make_request(Kind::rgb_png, path)), &RgbImage::rgb);
}

DepthImage PictureImporter::read_depth_png(const std::string& path) {
  return unpack_picture(worker_->ask(path, make_request(Kind::depth_png, path)), &DepthImage::values);
}

ExrImage PictureImporter::read_exr(const std::string& path, const std::vector<std::string>& channels) {
  return unpack_picture(worker_->ask(path, make_request(Kind::exr, path, channels)), &ExrImage::values);
}

namespace {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
PictureImporter& importer() {  // with one child until an input ends it
  static PictureImporter one;
  return one;
}
#else
PictureImporter importer() { return PictureImporter(); }
#endif

}  // namespace

RgbImage read_rgb_png(const std::string& path) { return importer().read_rgb_png(path); }

DepthImage read_depth_png(const std::string& path) { return importer().read_depth_png(path); }

ExrImage read_exr(const std::string& path, const std::vector<std::string>& channels) {
  return importer().read_exr(path, channels);
}

}  // namespace rubble
