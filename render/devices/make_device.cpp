#include "render/devices/make_device.h"

#include <algorithm>
#include <filesystem>

#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"

namespace rubble {

std::unique_ptr<Device> make_device(const DeviceChoice& choice) {
  if (choice.kind == DeviceKind::software) return std::make_unique<SoftwareDevice>();
  return std::make_unique<GlDevice>(GlContextOptions{choice.gl_device, choice.threads});
}

std::string find_card() {
  namespace fs = std::filesystem;
  std::vector<std::string> found;
  for (const auto& [folder, begin] : {std::pair("/dev", "nvidia"), std::pair("/dev/dri", "renderD")}) {
    std::error_code failed;
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed)) {
      const std::string name = i->path().filename().string(), prefix = begin;
      if (name.size() > prefix.size() && name.compare(0, prefix.size(), prefix) == 0 && name[prefix.size()] >= '0' &&
          name[prefix.size()] <= '9')
        found.push_back(i->path().string());
    }
    if (!found.empty()) return *std::min_element(found.begin(), found.end());
  }
  return "";
}

CardReport report_cards() {
  const GlReport report = report_gl();
  CardReport out;
  for (const GlReport::Candidate& candidate : report.candidates) out.ways.push_back({candidate.name, candidate.outcome});
  out.circumstances = report.circumstances;
  return out;
}

}  // namespace rubble
