#include "not_heard.h"

#include <algorithm>

#include "diagnostics.h"
#include "node/live_source.h"
#include "self_awareness/core/stream/event.h"
#include "session.h"

namespace self_awareness {
namespace {

std::string notHeard(const std::string& why) {
  return "not heard by the monitor: " + why;
}

}  // namespace

std::vector<ros1::Unheard> withoutOptional(std::vector<ros1::Unheard> unheard,
                                           const core::Acceptances& accepted,
                                           const ros1::Encoder& encoder) {
  const auto may_be_absent = [&](const ros1::Unheard& each) {
    return accepted.mayBeAbsent(encoder.sourceOf(each.node), encoder.scopeOf(each.topic));
  };
  unheard.erase(std::remove_if(unheard.begin(), unheard.end(), may_be_absent), unheard.end());
  return unheard;
}

void NotHeard::onVerdict(core::Verdict& verdict, ros1::Circumstances& /*circumstances*/) {
  if (!verdict.suspects.empty()) {
    const Session& session = *host_.session();
    set(host_.live().discovery().unheard(), *session.encoder());
    explain(verdict.suspects, session.vocabulary());
    explain(verdict.new_suspects, session.vocabulary());
  }
}

void NotHeard::onReport(MonitorState& state) {
  if (host_.session() != nullptr) {
    const Session& session = *host_.session();
    const ros1::Encoder& encoder = *session.encoder();
    state.unheard =
        withoutOptional(host_.live().discovery().unheard(), session.accepted(), encoder);
    set(state.unheard, encoder);
    state.communication.not_heard = components();
  }
}

void NotHeard::set(const std::vector<ros1::Unheard>& unheard, const ros1::Encoder& encoder) {
  why_.clear();
  for (const ros1::Unheard& each : unheard) {
    if (!each.dead && !each.node.empty()) {
      why_[{encoder.sourceOf(each.node), encoder.scopeOf(each.topic)}] = each.why;
    }
  }
}

void NotHeard::explain(std::vector<core::Suspect>& suspects,
                       const core::Vocabulary& vocabulary) const {
  for (core::Suspect& suspect : suspects) {
    const core::EventType& type = vocabulary.at(suspect.id);
    const auto why = why_.find({type.source, type.scope});
    if (why != why_.end() && core::isMissing(suspect.reason.kind)) {
      suspect.reason.words = notHeard(why->second);
    }
  }
}

std::map<std::string, std::string> NotHeard::components() const {
  std::map<std::string, std::string> components;
  for (const auto& [publication, why] : why_) {
    const auto& [source, topic] = publication;
    components.try_emplace(core::componentOf(source, topic), topic + ": " + notHeard(why));
  }
  return components;
}

}  // namespace self_awareness
