#include "blocked_node.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "core/verdict/name_list.h"
#include "node/live_source.h"
#include "self_awareness/core/verdict/suspect.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "session.h"

namespace self_awareness {

std::string whoBlocks(const std::set<std::string>& publishers,
                      const std::set<std::string>& subscribers,
                      const Discovery::Answers& answers) {
  const auto does = [&](const std::string& node, ros1::Answer what) {
    const auto answer = answers.find(node);
    return answer != answers.end() && answer->second == what;
  };
  if (!std::all_of(publishers.begin(), publishers.end(),
                   [&](const std::string& node) { return does(node, ros1::Answer::kGiven); })) {
    return "";
  }
  std::vector<std::string> blocking;
  std::copy_if(subscribers.begin(), subscribers.end(), std::back_inserter(blocking),
               [&](const std::string& node) { return does(node, ros1::Answer::kNone); });
  if (blocking.empty()) {
    return "";
  }
  const bool several = blocking.size() > 1;
  return std::string("it answers, but its subscriber") + (several ? "s " : " ") +
         core::listed(blocking, blocking.size()) + (several ? " do not" : " does not");
}

void BlockedNode::onVerdict(core::Verdict& verdict, ros1::Circumstances& /*circumstances*/) {
  if (!verdict.alarm) {
    return;
  }
  if (step_ == Step::kNone && !verdict.suspects.empty()) {
    const core::Suspect& first = verdict.suspects.front();
    step_ = Step::kTold;
    if (isSilence(first.reason.kind)) {
      ask(host_.session()->vocabulary().at(first.id));
    }
  } else if (step_ == Step::kAsked) {
    if (const std::optional<Discovery::Answers> answers = host_.live().discovery().answers()) {
      step_ = Step::kTold;
      verdict.note = whoBlocks(publishers_, subscribers_, *answers);
      verdict.changed = verdict.changed || !verdict.note.empty();
    }
  }
}

void BlockedNode::onAlarm(const ros1::AlarmState& alarm) {
  if (alarm.message().level != self_awareness::SelfAwareness::ERROR) {
    step_ = Step::kNone;
  } else if (step_ == Step::kNone) {
    step_ = Step::kTold;
  }
}

void BlockedNode::ask(const core::EventType& type) {
  publishers_.clear();
  subscribers_.clear();
  const ros1::Encoder& encoder = *host_.session()->encoder();
  if (!host_.live().graph()) {
    return;
  }
  for (const auto& [topic, nodes] : host_.live().graph()->topics) {
    for (const std::string& publisher : nodes.publishers) {
      if (encoder.sourceOf(publisher) == type.source) {
        publishers_.insert(publisher);
        subscribers_.insert(nodes.subscribers.begin(), nodes.subscribers.end());
      }
    }
  }
  std::vector<std::string> nodes(publishers_.begin(), publishers_.end());
  nodes.insert(nodes.end(), subscribers_.begin(), subscribers_.end());
  if (!publishers_.empty()) {
    step_ = Step::kAsked;
    ask_(std::move(nodes));
  }
}

}  // namespace self_awareness
