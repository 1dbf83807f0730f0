#pragma once

#include <string>

namespace self_awareness::ros1 {

/// Asks a node where it publishes a topic: the call "requestTopic" of its slave API. Nothing of it
/// waits, and an answer is bounded: roscpp's own call reads as much as the node likes to send.
class TopicRequest {
 public:
  /// Most bytes of an answer; a true one has some hundred.
  static constexpr std::size_t kMostBytes = 65536;

  enum class State {
    kAsking,
    kAnswered,
    kRefused,  ///< nobody listens there, as far as its machine says
    kFailed
  };

  /// @param ip, port of the node's XML-RPC server
  /// @param host by which others know it
  TopicRequest(const std::string& ip, int port, const std::string& host, const std::string& topic);
  ~TopicRequest();
  TopicRequest(const TopicRequest&) = delete;
  TopicRequest& operator=(const TopicRequest&) = delete;

  /// What poll() has to wait for, while it is asking.
  int socket() const { return socket_; }
  short events() const;
  /// Goes on as far as possible without waiting.
  void advance();

  State state() const { return state_; }
  /// Why there is no answer, once it is refused or failed.
  const std::string& why() const { return why_; }
  /// Where the topic is published, once it is answered.
  const std::string& host() const { return data_host_; }
  int port() const { return data_port_; }

 private:
  void send();
  void receive();
  void readAnswer(const std::string& body);
  void end(State state, const std::string& why);
  void endByError(int error);

  int socket_ = -1;
  State state_ = State::kAsking;
  std::string why_;
  std::string request_;  // what is left to send
  std::string answer_;   // so far
  std::string data_host_;
  int data_port_ = 0;
};

}  // namespace self_awareness::ros1
