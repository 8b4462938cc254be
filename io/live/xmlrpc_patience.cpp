// Two functions of xmlrpcpp under the library's own names. The loader gives them to roscpp, too, as
// an executable's symbols come before those of libraries.
//
// Requests to a master end: the library waits for an answer without end, and roscpp asks in every
// call that advertises, subscribes or shuts down, so that a master that is stopped would hold the
// program for ever. And values lie in one another only so deep: the library's parser calls itself
// for each, also for requests that anybody sends to the port of roscpp, until the stack is full.
#include <dlfcn.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <string>

namespace {

constexpr double kXmlRpcPatience = 5,
                 kLittlePatience = 0.25;  // of a master that once let us wait; unit: s
constexpr int kDeepest = 32;              // the Master API needs five levels

std::atomic<bool> let_us_wait{false};

struct Level {
  Level() { ++depth; }
  ~Level() { --depth; }
  static thread_local int depth;
};
thread_local int Level::depth = 0;

}  // namespace

// False, as of the library, when there is no answer, or none that can be read.
bool XmlRpc::XmlRpcClient::execute(const char* method, const XmlRpcValue& params,
                                   XmlRpcValue& result) {
  if (!executeNonBlock(method, params)) return false;
  _disp.work(let_us_wait ? kLittlePatience : kXmlRpcPatience);
  const bool answered = _connectionState == IDLE;
  let_us_wait = !answered && _connectionState != NO_CONNECTION;
  if (answered) return executeCheckDone(result) && result.valid();
  close();
  return false;
}

bool XmlRpc::XmlRpcValue::fromXml(const std::string& xml, int* offset) {
  using Parse = bool (*)(XmlRpcValue*, const std::string&, int*);
  static const auto parse = reinterpret_cast<Parse>(
      dlsym(RTLD_NEXT,
            "_ZN6XmlRpc11XmlRpcValue7fromXmlERKNSt7__cxx1112basic_stringIcSt11char_"
            "traitsIcESaIcEEEPi"));
  const Level level;
  return parse && Level::depth <= kDeepest && parse(this, xml, offset);
}
