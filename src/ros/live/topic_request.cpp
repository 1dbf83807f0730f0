#include "topic_request.h"

#include <netdb.h>
#include <poll.h>
#include <ros/this_node.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "../text.h"

namespace self_awareness::ros1 {
namespace {

using XmlRpc::XmlRpcValue;

constexpr std::size_t kMostWords = 200;

std::string requestFor(const std::string& host, int port, const std::string& topic) {
  XmlRpcValue protocols;
  protocols[0][0] = "TCPROS";
  const std::array<XmlRpcValue, 3> parameters{XmlRpcValue(ros::this_node::getName()),
                                              XmlRpcValue(topic), protocols};
  std::string body =
      "<?xml version=\"1.0\"?>\r\n<methodCall><methodName>requestTopic</methodName>"
      "\r\n<params>";
  for (const XmlRpcValue& parameter : parameters) {
    body += "<param>" + parameter.toXml() + "</param>";
  }
  body += "</params></methodCall>\r\n";
  return "POST / HTTP/1.1\r\nHost: " + host + ":" + std::to_string(port) +
         "\r\nConnection: close\r\nContent-Type: text/xml\r\nContent-length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// Where the body begins and ends; none: not all is there yet.
std::optional<std::string> bodyOf(const std::string& answer) {
  const std::size_t blank = answer.find("\r\n\r\n");
  if (blank == std::string::npos) {
    return std::nullopt;
  }
  static const char kLength[] = "content-length:";
  for (std::size_t line = 0; line < blank; line = answer.find("\r\n", line) + 2) {
    if (strncasecmp(answer.c_str() + line, kLength, sizeof kLength - 1) == 0) {
      const std::size_t length =
          std::strtoul(answer.c_str() + line + sizeof kLength - 1, nullptr, 10);
      const std::string body = answer.substr(blank + 4);
      return body.size() >= length ? std::optional(body.substr(0, length)) : std::nullopt;
    }
  }
  return "";  // no length: not what a node answers
}

}  // namespace

TopicRequest::TopicRequest(const std::string& ip, int port, const std::string& host,
                           const std::string& topic)
    : request_(requestFor(host, port, topic)) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  addrinfo* address = nullptr;
  if (getaddrinfo(ip.c_str(), std::to_string(port).c_str(), &hints, &address) != 0) {
    end(State::kFailed, "its address is none");
    return;
  }
  socket_ = ::socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0 ||
      (connect(socket_, address->ai_addr, address->ai_addrlen) != 0 && errno != EINPROGRESS)) {
    endByError(errno);
  }
  freeaddrinfo(address);
}

TopicRequest::~TopicRequest() {
  if (socket_ >= 0) {
    close(socket_);
  }
}

short TopicRequest::events() const {
  return request_.empty() ? POLLIN : POLLOUT;
}

void TopicRequest::advance() {
  if (state_ == State::kAsking && !request_.empty()) {
    send();
  }
  if (state_ == State::kAsking && request_.empty()) {
    receive();
  }
}

void TopicRequest::send() {
  const ssize_t sent = ::send(socket_, request_.data(), request_.size(), MSG_NOSIGNAL);
  if (sent >= 0) {
    request_.erase(0, static_cast<std::size_t>(sent));
  } else if (errno != EAGAIN && errno != EINTR && errno != ENOTCONN) {
    endByError(errno);
  }
}

void TopicRequest::receive() {
  std::array<char, 4096> part{};
  const ssize_t received = recv(socket_, part.data(), part.size(), 0);
  if (received < 0) {
    if (errno != EAGAIN && errno != EINTR) {
      endByError(errno);
    }
    return;
  }
  answer_.append(part.data(), static_cast<std::size_t>(received));
  if (answer_.size() > kMostBytes) {
    end(State::kFailed, "its answer is too long");
  } else if (const std::optional<std::string> body = bodyOf(answer_)) {
    readAnswer(*body);
  } else if (received == 0) {
    end(State::kFailed, "it ends the call without an answer");
  }
}

void TopicRequest::readAnswer(const std::string& body) {
  try {
    const std::size_t begin = body.find("<value>");
    int offset = static_cast<int>(begin == std::string::npos ? body.size() : begin);
    XmlRpcValue answer(body, &offset);  // [code, words, [protocol, host, port]]
    if (answer.getType() == XmlRpcValue::TypeArray && answer.size() == 3 &&
        answer[2].getType() == XmlRpcValue::TypeArray && answer[2].size() >= 3) {
      data_host_ = static_cast<std::string>(answer[2][1]);
      data_port_ = static_cast<int>(answer[2][2]);
      if (static_cast<std::string>(answer[2][0]) == "TCPROS" && data_port_ > 0 &&
          data_port_ < 65536) {
        end(State::kAnswered, "");
        return;
      }
    }
    const bool has_words = answer.getType() == XmlRpcValue::TypeArray && answer.size() > 1 &&
                           answer[1].getType() == XmlRpcValue::TypeString;
    end(State::kFailed,
        "it does not offer the topic" +
            (has_words ? ": " + printable(static_cast<std::string>(answer[1]), kMostWords) : ""));
  } catch (const XmlRpc::XmlRpcException&) {
    end(State::kFailed, "its answer is none of a node");
  }
}

void TopicRequest::end(State state, const std::string& why) {
  state_ = state;
  why_ = why;
}

void TopicRequest::endByError(int error) {
  if (error == ECONNREFUSED) {
    end(State::kRefused, "nobody listens at its address");
  } else {
    end(State::kFailed, std::strerror(error));
  }
}

}  // namespace self_awareness::ros1
