// Programs that run beside a test: masters, recorders, subscribers.
#pragma once

#include <sys/types.h>

#include <functional>
#include <set>
#include <string>

namespace rubble::testing {

class Background {
 public:
  // Starts `command` by the shell, in a process group of its own; what it prints goes to the file
  // `output`.
  Background(const std::string& command, const std::string& output);
  ~Background();  // as Ctrl-C does; who does not end by it is killed
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void signal(int number);
  pid_t pid() const { return pid_; }
  bool ended();
  // Its exit code, or 128 and a signal; -1 when it has not ended after so many seconds.
  int wait(double seconds);
  std::string output() const;

 private:
  pid_t pid_ = -1;
  std::string output_;
  bool ended_ = false;
  int status_ = 0;
};

// Whether it became true within so many seconds.
bool eventually(double seconds, const std::function<bool()>& condition);

// A TCP port of the loopback interface that nobody uses now.
int free_port();

// The IPv4 and IPv6 addresses on which a process listens for TCP connections, one for each socket, as
// the kernel lists them in hexadecimal.
std::multiset<std::string> listening_addresses(pid_t process);

}  // namespace rubble::testing
