#include "accept_service.h"

#include <utility>

#include "diagnostics.h"
#include "node/live_source.h"
#include "parameters.h"
#include "ros/now.h"
#include "session.h"

namespace self_awareness {

AcceptService::AcceptService(OperatorCalls& calls, Host& host,
                             std::function<const self_awareness::Incidents&()> incidents)
    : calls_(calls),
      host_(host),
      incidents_(std::move(incidents)),
      accepts_(calls_, {[this] { return acceptable(); },
                        [this](const std::string& caller) { onAccepted(caller); }}) {}

std::vector<ros::ServiceServer> AcceptService::advertise(ros::NodeHandle& private_node_handle) {
  return {accepts_.advertise(private_node_handle)};
}

void AcceptService::onStart(const Session& /*session*/, const std::string& path) {
  accepts_.read(path);
  host_.session()->accept(accepts_.accepted());
}

void AcceptService::onReport(MonitorState& state) {
  state.accept_error = accepts_.error();
  if (host_.session() != nullptr) {
    accepts_.tell(host_.session()->types(), state.communication);
  }
}

std::optional<Acceptable> AcceptService::acceptable() {
  Session* const session = host_.session();
  if (session == nullptr || host_.parameters().method != MonitorParameters::Method::kEvidence) {
    return std::nullopt;
  }
  return Acceptable{host_.alarm().standing(),      incidents_(),        session->vocabulary(),
                    session->detector().unknown(), *session->encoder(), host_.live().now()};
}

void AcceptService::onAccepted(const std::string& caller) {
  Session& session = *host_.session();
  session.accept(accepts_.accepted());
  const std::optional<core::Alarm>& stands = host_.alarm().standing();
  if (stands && accepts_.covers(*stands, session.vocabulary())) {
    calls_.record("accept", caller, wallNow());
    session.detector().clearAlarm();
    host_.standDown("accepted, by " + caller);
  }
  host_.report();
}

}  // namespace self_awareness
