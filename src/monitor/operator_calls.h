#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace self_awareness {

/// Who called the services that take an alarm back, and whether that is too often: anybody can
/// call them, and a loop that does would keep every alarm down, and fill the log.
///
/// Times are steady [ns].
class OperatorCalls {
 public:
  /// So many calls of a service are answered at once; afterwards one in kPause.
  static constexpr int kAtOnce = 5;
  static constexpr std::int64_t kPause = 10000000000;

  /// Whether this call of a service may be answered. Logs who called: each call that may, and not
  /// more than one in kPause of the others.
  /// @param caller full name of the node
  bool admit(const std::string& service, const std::string& caller, std::int64_t now);
  /// The same of a call with an answer of `success` and `message`, which says why it may not.
  template <typename Call>
  bool mayServe(const std::string& service, Call& call, std::int64_t now) {
    const bool may = admit(service, call.getCallerName(), now);
    if (!may) {
      call.getResponse().success = 0U;
      call.getResponse().message = refusal(service);
    }
    return may;
  }

  /// Who took back an alarm last, and when, in words; empty: nobody did.
  const std::string& onRecord() const { return on_record_; }
  /// An alarm was taken back. @param at since 1970 [ns]
  void record(const std::string& service, const std::string& caller, std::int64_t at);

 private:
  static std::string refusal(const std::string& service);

  struct Service {
    double calls = kAtOnce;  // that are answered now
    std::int64_t counted_at = 0;
    std::int64_t refused_at = -kPause;  // and logged
  };

  std::map<std::string, Service> services_;
  std::string on_record_;
};

}  // namespace self_awareness
