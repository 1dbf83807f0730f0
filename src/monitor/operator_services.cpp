#include "operator_services.h"

#include <utility>

#include "diagnostics.h"
#include "parameters.h"
#include "ros/text.h"
#include "self_awareness/ros/ros_time.h"
#include "session.h"

namespace self_awareness {

OperatorServices::OperatorServices(OperatorCalls& calls, Host& host,
                                   std::function<std::string()> reload)
    : calls_(calls), host_(host), reload_(std::move(reload)) {}

std::vector<ros::ServiceServer> OperatorServices::advertise(ros::NodeHandle& private_node_handle) {
  return {private_node_handle.advertiseService("reset", &OperatorServices::onReset, this),
          private_node_handle.advertiseService("clear", &OperatorServices::onClear, this),
          private_node_handle.advertiseService("reload", &OperatorServices::onReload, this)};
}

void OperatorServices::onReport(MonitorState& state) {
  state.taken_back = calls_.onRecord();
}

void OperatorServices::standDown(const Call& call, const std::string& service,
                                 const std::string& message) {
  if (host_.alarm().stands()) {
    calls_.record(service, call.getCallerName(), ros1::wallNow());
  }
  host_.standDown(message);
}

bool OperatorServices::onReset(Call& call) {
  if (!calls_.mayServe("reset", call, ros1::steadyNow())) {
    return true;
  }
  Session* const session = host_.session();
  call.getResponse().success = session != nullptr;
  if (session == nullptr) {
    call.getResponse().message = "there is no model: /diagnostics says why";
  } else {
    call.getResponse().message = "delays, windows and the alarm start afresh";
    session->detector().restart();
    standDown(call, "reset", "settling: reset");
  }
  return true;
}

bool OperatorServices::onClear(Call& call) {
  if (calls_.mayServe("clear", call, ros1::steadyNow())) {
    const bool stood = host_.alarm().stands();
    call.getResponse().success = 1U;
    call.getResponse().message = stood ? "the alarm is cleared" : "there is no alarm";
    if (stood) {
      host_.session()->detector().clearAlarm();
      standDown(call, "clear", "cleared by hand, by " + ros1::printable(call.getCallerName()));
    }
  }
  return true;
}

bool OperatorServices::onReload(Call& call) {
  if (!calls_.mayServe("reload", call, ros1::steadyNow())) {
    return true;
  }
  const std::string error = reload_();
  call.getResponse().success = error.empty();
  if (error.empty()) {
    standDown(call, "reload", "settling: model loaded");
    call.getResponse().message = "loaded " + host_.parameters().model;
  } else {
    call.getResponse().message = error;
  }
  return true;
}

}  // namespace self_awareness
