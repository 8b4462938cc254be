#include "app/session/live_colours.h"

#include "kernel/base/system/disk_cache.h"

namespace rubble {
namespace {

RenderOptions render_options(int threads) {
  RenderOptions options;
  options.threads = threads;
  options.cache_folder = DiskCache::usual_folder();
  return options;
}

}  // namespace

LiveColours::LiveColours(const Scene& scene, const LiveColoursOptions& options)
    : gl_({options.gl_device, options.threads}),
      renderer_(gl_, scene, render_options(options.threads), options.progress) {}

}  // namespace rubble
