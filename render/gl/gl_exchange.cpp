#include "render/gl/gl_exchange.h"

#include <algorithm>
#include <cstring>

#include "kernel/base/error.h"

namespace rubble {

namespace {

constexpr std::size_t kBlock = 512;        // that is handed over together; unit: byte
constexpr GLuint64 kWaitNs = 1000000000;  // of one look whether the card is done

}  // namespace

void GlMirror::give(const void* data, std::size_t bytes) {
  if (bytes == there_.size() && bytes > 0) return give_part(data, 0, bytes);
  const char* from = static_cast<const char*>(data);
  there_.assign(from, from + bytes);
  // GL refuses size 0.
  give_buffer(*gl_, buffer_.name(), std::max<std::size_t>(bytes, 16), bytes ? data : nullptr, GL_DYNAMIC_DRAW);
}

void GlMirror::give_part(const void* data, std::size_t begin, std::size_t end) {
  const char* from = static_cast<const char*>(data);
  std::size_t first = end;  // of a run of blocks that differ
  const auto give_run = [&](std::size_t last) {
    if (first < last) give_buffer_part(*gl_, buffer_.name(), first, last - first, from + first);
    first = end;
  };
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    if (std::memcmp(&there_[i], from + i, count) == 0) {
      give_run(i);
    } else {
      std::memcpy(&there_[i], from + i, count);
      first = std::min(first, i);
    }
  }
  give_run(end);
}

GlComing::~GlComing() {
  if (fence_) gl_->DeleteSync(fence_);
}

// It stays mapped, so that to read it waits for nothing but the fence.
void GlComing::make_room(std::size_t bytes) {
  bytes_ = bytes;
  if (bytes <= room_) return;
  room_ = bytes;
  constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  buffer_ = GlBuffer(*gl_);
  gl_->NamedBufferStorage(buffer_.name(), GLsizeiptr(room_), nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
  memory_ = static_cast<const char*>(gl_->MapNamedBufferRange(buffer_.name(), 0, GLsizeiptr(room_), kAccess));
  check_gl(*gl_, "making room for what comes back");
  if (!memory_) throw RunError("the graphics device does not let its memory be read");
}

void GlComing::sign() {
  if (fence_) gl_->DeleteSync(fence_);
  fence_ = gl_->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  asked_ = ++gl_->traffic->asked;
}

void GlComing::take(void* to, std::size_t offset, std::size_t bytes) {
  if (asked_ > gl_->traffic->done) {
    ++gl_->traffic->waits;
    GLenum state = GL_TIMEOUT_EXPIRED;
    while (state == GL_TIMEOUT_EXPIRED) state = gl_->ClientWaitSync(fence_, GL_SYNC_FLUSH_COMMANDS_BIT, kWaitNs);
    if (state == GL_WAIT_FAILED) throw RunError("the graphics device stopped while it drew");
    gl_->traffic->done = asked_;
  }
  gl_->traffic->taken += bytes;
  if (bytes > 0) std::memcpy(to, memory_ + offset, bytes);
}

std::shared_ptr<GlComing> GlReadback::open(std::size_t bytes) {
  auto free = std::find_if(all_.begin(), all_.end(), [](const auto& one) { return one.use_count() == 1; });
  if (free == all_.end()) free = all_.insert(all_.end(), std::make_shared<GlComing>(*gl_));
  (*free)->make_room(bytes);
  return *free;
}

std::shared_ptr<GlComing> GlReadback::ask(int width, int height, GLenum format, GLenum type) {
  auto coming = open(std::size_t(width) * std::size_t(height) * bytes_of_pixel(format, type));
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, coming->buffer_.name());
  gl_->ReadPixels(0, 0, width, height, format, type, nullptr);
  gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  coming->sign();
  return coming;
}

std::shared_ptr<GlComing> GlReadback::ask(const std::vector<Part>& parts) {
  std::size_t bytes = 0;
  for (const Part& part : parts) bytes += part.bytes;
  auto coming = open(bytes);
  std::size_t to = 0;
  for (const Part& part : parts) {
    gl_->CopyNamedBufferSubData(part.buffer, coming->buffer_.name(), GLintptr(part.offset), GLintptr(to), GLsizeiptr(part.bytes));
    to += part.bytes;
  }
  coming->sign();
  return coming;
}

}  // namespace rubble
