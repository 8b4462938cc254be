#include "tests/live/background.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/app/program.h"

namespace rubble::testing {

Background::Background(const std::string& command, const std::string& output) : output_(output) {
  const std::string line = command + " >'" + output + "' 2>&1 </dev/null";
  pid_ = fork();
  if (pid_ == 0) {
    setpgid(0, 0);
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  setpgid(pid_, pid_);
}

Background::~Background() {
  if (ended()) return;
  signal(SIGINT);
  if (eventually(10, [this] { return ended(); })) return;
  signal(SIGKILL);
  waitpid(pid_, &status_, 0);
}

void Background::signal(int number) { kill(-pid_, number); }

bool Background::ended() {
  if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
  return ended_;
}

int Background::wait(double seconds) {
  if (!eventually(seconds, [this] { return ended(); })) return -1;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

std::string Background::output() const { return read_file(output_); }

bool eventually(double seconds, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

int free_port() {
  const int socket_number = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(socket_number, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(socket_number, reinterpret_cast<sockaddr*>(&address), &size);
  close(socket_number);
  return ntohs(address.sin_port);
}

std::multiset<std::string> listening_addresses(pid_t process) {
  namespace fs = std::filesystem;
  const std::string folder = "/proc/" + std::to_string(process);
  std::set<std::string> own;  // sockets, as "socket:[INODE]"
  for (const auto& entry : fs::directory_iterator(folder + "/fd")) {
    std::error_code gone;
    own.insert(fs::read_symlink(entry.path(), gone).string());
  }
  std::multiset<std::string> addresses;
  for (const char* table : {"/net/tcp", "/net/tcp6"}) {
    std::ifstream in(folder + table);
    std::string line, number, local, remote, state, skipped, inode;
    for (std::getline(in, line); std::getline(in, line);) {
      std::istringstream row(line);
      row >> number >> local >> remote >> state;
      for (int i = 0; i < 5; ++i) row >> skipped;
      row >> inode;
      const bool listens = state == "0A";
      if (listens && own.count("socket:[" + inode + "]"))
        addresses.insert(local.substr(0, local.find(':')));
    }
  }
  return addresses;
}

}  // namespace rubble::testing
