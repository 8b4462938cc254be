// Shadows of the lamp, see shading/contact.h.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "render/camera/projection.h"
#include "render/colour/view_lamp.h"
#include "render/shading/wide_shader.h"

namespace rubble {

class OpennessGrids {
 public:
  // Nothing where the lamp is not on. depth_values: near / Z, of the view's size. Only the rows [first_row, last_row) of
  // the view are wanted.
  void find(const WideShader& shader, const ViewProjection& view,
            const std::vector<float>& depth_values, const ContactLamp& lamp,
            int first_row, int last_row, ThreadPool& pool);
  OpennessGrid view() const;

 private:
  void smooth(ThreadPool& pool);

  int width_ = 0, height_ = 0, stride_ = 0;
  bool lamp_ = false;
  std::vector<float> raw_, lamp_seen_;
};

}  // namespace rubble
