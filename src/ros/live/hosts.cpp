#include "self_awareness/ros/live/hosts.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <ros/transport/transport_tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "self_awareness/core/stream/event.h"

namespace self_awareness::ros1 {
namespace {

// glibc has twenty threads for this.
constexpr std::size_t kMostAtOnce = 16;
constexpr std::size_t kMostKnown = 10000;
constexpr std::int64_t kFoundFor = 60 * core::kNanosecondsPerSecond;
constexpr std::int64_t kUnknownFor = 10 * core::kNanosecondsPerSecond;

bool isNumeric(const std::string& host) {
  std::array<std::uint8_t, sizeof(in6_addr)> address{};
  return inet_pton(AF_INET, host.c_str(), address.data()) == 1 ||
         inet_pton(AF_INET6, host.c_str(), address.data()) == 1;
}

std::string textOf(const addrinfo& found) {
  std::array<char, NI_MAXHOST> text{};
  return getnameinfo(found.ai_addr, found.ai_addrlen, text.data(), text.size(), nullptr, 0,
                     NI_NUMERICHOST) == 0
             ? text.data()
             : "";
}

}  // namespace

/// What glibc works on; it must stay where it is until glibc is done with it.
struct Hosts::Lookup {
  std::string host;
  addrinfo hints{};
  gaicb request{};
};

Hosts::Hosts() = default;

Hosts::~Hosts() {
  for (auto& [host, known] : known_) {
    if (known.lookup && gai_cancel(&known.lookup->request) == EAI_NOTCANCELED) {
      // glibc writes into it some time: it is lost, or the process is.
      static_cast<void>(known.lookup.release());
    }
  }
}

Hosts::Answer Hosts::find(const std::string& host, std::int64_t now) {
  if (isNumeric(host)) {
    return {State::kFound, host};
  }
  if (known_.size() >= kMostKnown && known_.count(host) == 0) {
    for (auto known = known_.begin(); known != known_.end();) {
      const bool old = !known->second.lookup && known->second.good_until < now;
      known = old ? known_.erase(known) : std::next(known);
    }
    if (known_.size() >= kMostKnown) {
      return {};
    }
  }
  Known& known = known_[host];
  if (known.lookup) {
    finish(known, now);
  } else if (known.good_until < now) {
    if (known.answer.state == State::kUnknown) {
      known.answer = {};  // that was then: nobody is put off before it is looked up again
    }
    start(host, known);
  }
  return known.answer;
}

void Hosts::start(const std::string& host, Known& known) {
  if (looking_ >= kMostAtOnce) {
    return;
  }
  known.lookup = std::make_unique<Lookup>();
  known.lookup->host = host;
  known.lookup->hints.ai_socktype = SOCK_STREAM;
  // roscpp's sockets are of the one family or of the other.
  known.lookup->hints.ai_family = ros::TransportTCP::s_use_ipv6_ ? AF_INET6 : AF_INET;
  known.lookup->hints.ai_flags = ros::TransportTCP::s_use_ipv6_ ? AI_V4MAPPED : 0;
  known.lookup->request.ar_name = known.lookup->host.c_str();
  known.lookup->request.ar_request = &known.lookup->hints;
  std::array<gaicb*, 1> requests{&known.lookup->request};
  if (getaddrinfo_a(GAI_NOWAIT, requests.data(), 1, nullptr) != 0) {
    known.lookup.reset();
    return;
  }
  ++looking_;
}

void Hosts::finish(Known& known, std::int64_t now) {
  const int error = gai_error(&known.lookup->request);
  if (error == EAI_INPROGRESS) {
    return;
  }
  addrinfo* const found = known.lookup->request.ar_result;
  const std::string ip = error == 0 && found != nullptr ? textOf(*found) : "";
  if (found != nullptr) {
    freeaddrinfo(found);
  }
  known.lookup.reset();
  --looking_;
  known.answer = {ip.empty() ? State::kUnknown : State::kFound, ip};
  known.good_until = now + (ip.empty() ? kUnknownFor : kFoundFor);
}

}  // namespace self_awareness::ros1
