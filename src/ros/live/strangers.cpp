#include "self_awareness/ros/live/strangers.h"

#include <dirent.h>
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
#include <utility>
#include <vector>

namespace self_awareness::ros1 {
namespace {

/// A file of this process that nobody else closes meanwhile: its number may be in use for another
/// one as soon as it is looked at.
class OwnFile {
 public:
  explicit OwnFile(int number) : number_(fcntl(number, F_DUPFD_CLOEXEC, 0)) {}
  ~OwnFile() {
    if (number_ >= 0) {
      close(number_);
    }
  }
  OwnFile(OwnFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OwnFile& operator=(OwnFile&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

std::vector<int> openFiles() {
  std::vector<int> files;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
  while (const dirent* const entry = folder ? readdir(folder.get()) : nullptr) {
    if (entry->d_name[0] != '.') {
      files.push_back(std::atoi(entry->d_name));
    }
  }
  return files;
}

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
void end(const OwnFile& file) {
  shutdown(file.number(), SHUT_RDWR);
}

}  // namespace

Strangers::Seen Strangers::look(std::int64_t now, int slave_port, int data_port) {
  Seen seen;
  std::map<std::string, Connection> all;
  std::vector<std::pair<std::uint32_t, OwnFile>> callers;  // by how long they said nothing [ms]
  for (const int number : openFiles()) {
    if (!socketOf(number, slave_port, data_port)) {
      continue;
    }
    OwnFile file(number);
    const std::optional<Socket> socket = socketOf(file.number(), slave_port, data_port);
    if (!socket || all.count(socket->ends) > 0) {  // one of ours may have the number of another
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
      callers.emplace_back(socket->info.tcpi_last_data_recv, std::move(file));
    }
    all[socket->ends] = connection;
  }
  known_ = std::move(all);
  if (callers.size() > kMost) {
    std::sort(callers.begin(), callers.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; i < callers.size() - kMost; ++i) {
      end(callers[i].second);
      ++seen.closed;
    }
  }
  return seen;
}

}  // namespace self_awareness::ros1
