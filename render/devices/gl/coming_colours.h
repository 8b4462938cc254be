// What GlColourPass has drawn, on its way to the processor.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "render/colour/colour_pass.h"
#include "render/gl/gl_exchange.h"

namespace rubble {

class ComingColours : public DrawnColours {
 public:
  explicit ComingColours(std::shared_ptr<GlComing> coming) : coming_(std::move(coming)) {}

  float take(std::vector<std::uint8_t>& rgb) override {
    float exposure = 0;
    coming_->take(&exposure, 0, sizeof exposure);
    rgb.resize(coming_->size() - sizeof exposure);
    coming_->take(rgb.data(), sizeof exposure, rgb.size());
    return exposure;
  }

 private:
  std::shared_ptr<GlComing> coming_;  // the exposure, and three bytes a pixel
};

class ComingRadiance : public DrawnRadiance {
 public:
  explicit ComingRadiance(std::shared_ptr<GlComing> coming) : coming_(std::move(coming)) {}

  std::vector<float> take() override {
    std::vector<float> out(coming_->size() / sizeof(float));
    coming_->take(out.data());
    return out;
  }

 private:
  std::shared_ptr<GlComing> coming_;
};

}  // namespace rubble
