#include "self_awareness/ros/live/strangers.h"

#include <fcntl.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

namespace self_awareness::ros1 {

/// One file of this process that nobody else closes meanwhile: its number may be in use for
/// another one as soon as it is looked at. It needs no free number for that.
class Strangers::HeldFile {
 public:
  HeldFile() : none_(open("/dev/null", O_RDONLY | O_CLOEXEC)), held_(dup(none_)) { letGo(); }
  ~HeldFile() {
    close(none_);
    close(held_);
  }
  HeldFile(const HeldFile&) = delete;
  HeldFile& operator=(const HeldFile&) = delete;

  /// Holds a file instead of the one before.
  /// @return its number here; -1: there is no such file
  int hold(int number) { return dup3(number, held_, O_CLOEXEC); }
  /// Whoever it belongs to can close it for good.
  void letGo() { dup3(none_, held_, O_CLOEXEC); }

 private:
  int none_;
  int held_;
};

namespace {

int portOf(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET6) {
    return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  }
  return address.ss_family == AF_INET
             ? ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port)
             : 0;
}

struct Socket {
  int port = 0;      // of this side
  std::string ends;  // both, as the kernel has them
  tcp_info info{};
};

std::optional<Socket> socketOf(int file, int slave_port, int data_port) {
  sockaddr_storage own{};
  sockaddr_storage other{};
  socklen_t own_size = sizeof own;
  socklen_t other_size = sizeof other;
  Socket found;
  socklen_t info_size = sizeof found.info;
  if (getsockname(file, reinterpret_cast<sockaddr*>(&own), &own_size) != 0) {
    return std::nullopt;
  }
  found.port = portOf(own);
  if (found.port == 0 || (found.port != slave_port && found.port != data_port) ||
      getpeername(file, reinterpret_cast<sockaddr*>(&other), &other_size) != 0 ||
      getsockopt(file, IPPROTO_TCP, TCP_INFO, &found.info, &info_size) != 0 ||
      info_size < offsetof(tcp_info, tcpi_bytes_sent) + sizeof found.info.tcpi_bytes_sent) {
    return std::nullopt;
  }
  found.ends = std::string(reinterpret_cast<const char*>(&own), own_size) +
               std::string(reinterpret_cast<const char*>(&other), other_size);
  return found;
}

// What it reads from it ends there, and roscpp closes it.
void end(int file) {
  shutdown(file, SHUT_RDWR);
}

struct Caller {
  std::uint32_t silent_for;  // [ms]
  int number;                // of the file
  std::string ends;
};

}  // namespace

Strangers::Strangers() : folder_(opendir("/proc/self/fd")), held_(std::make_unique<HeldFile>()) {}

Strangers::~Strangers() = default;

std::vector<int> Strangers::openFiles() {
  std::vector<int> files;
  if (folder_) {
    rewinddir(folder_.get());
  }
  while (const dirent* const entry = folder_ ? readdir(folder_.get()) : nullptr) {
    if (entry->d_name[0] != '.') {
      files.push_back(std::atoi(entry->d_name));
    }
  }
  return files;
}

Strangers::Seen Strangers::look(std::int64_t now, int slave_port, int data_port) {
  Seen seen;
  std::map<std::string, Connection> all;
  std::vector<Caller> callers;
  for (const int number : openFiles()) {
    if (!socketOf(number, slave_port, data_port)) {
      continue;
    }
    const int file = held_->hold(number);
    const std::optional<Socket> socket = socketOf(file, slave_port, data_port);
    if (!socket) {
      continue;
    }
    const auto known = known_.find(socket->ends);
    Connection connection = known == known_.end() ? Connection{now, 0, 0, 0} : known->second;
    if (socket->info.tcpi_bytes_sent != connection.sent) {
      connection.since = now;
      connection.received_until = socket->info.tcpi_bytes_received;
      connection.sent = socket->info.tcpi_bytes_sent;
    }
    const bool to_slave = socket->port == slave_port;
    seen.called =
        seen.called || (to_slave && socket->info.tcpi_bytes_received != connection.received);
    connection.received = socket->info.tcpi_bytes_received;
    const bool never_answered = connection.sent == 0 && now - connection.since > kPatience;
    // A service may be asked for something large, once it has answered the header.
    const bool sends_too_much =
        connection.received - connection.received_until > kMostUnanswered &&
        (to_slave || connection.sent == 0);
    if (never_answered || sends_too_much) {
      end(file);
      ++seen.closed;
    } else if (to_slave) {
      callers.push_back({socket->info.tcpi_last_data_recv, number, socket->ends});
    }
    all[socket->ends] = connection;
  }
  known_ = std::move(all);
  if (callers.size() > kMost) {
    std::sort(callers.begin(), callers.end(),
              [](const auto& a, const auto& b) { return a.silent_for > b.silent_for; });
    for (std::size_t i = 0; i < callers.size() - kMost; ++i) {
      const int file = held_->hold(callers[i].number);
      const std::optional<Socket> socket = socketOf(file, slave_port, data_port);
      if (socket && socket->ends == callers[i].ends) {
        end(file);
        ++seen.closed;
      }
    }
  }
  held_->letGo();
  return seen;
}

}  // namespace self_awareness::ros1
