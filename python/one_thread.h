// Objects that one thread at a time may use. Their calls let other Python threads run meanwhile, so that two calls of one
// object at once would change the same data.
#pragma once

#include <atomic>
#include <utility>

#include "kernel/base/error.h"

namespace rubble::python {

class OneThread {
 public:
  // While it lives, no other call may begin. Throws RunError where another one has not ended.
  class Use {
   public:
    explicit Use(const OneThread& object) : object_(object) {
      if (object.busy_.exchange(true, std::memory_order_acquire))
        throw RunError("another thread is using this object: each thread needs an object of its own, also of the same pile");
    }
    ~Use() { object_.busy_.store(false, std::memory_order_release); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    const OneThread& object_;
  };

 private:
  mutable std::atomic<bool> busy_{false};
};

// A method as a function for nanobind that begins with a Use.
template <typename Object, typename Result, typename... Arguments>
auto in_one_thread(Result (Object::*method)(Arguments...)) {
  return [method](Object& object, Arguments... arguments) -> Result {
    const OneThread::Use use(object);
    return (object.*method)(std::forward<Arguments>(arguments)...);
  };
}
template <typename Object, typename Result, typename... Arguments>
auto in_one_thread(Result (Object::*method)(Arguments...) const) {
  return [method](const Object& object, Arguments... arguments) -> Result {
    const OneThread::Use use(object);
    return (object.*method)(std::forward<Arguments>(arguments)...);
  };
}

}  // namespace rubble::python
