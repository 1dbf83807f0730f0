#include "blocked_node.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "core/verdict/name_list.h"
#include "node/live_source.h"
#include "self_awareness/core/verdict/suspect.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/graph.h"
#include "session.h"

namespace self_awareness {

BlockedNode::BlockedNode(Host& host, Ask ask) : host_(host), ask_(std::move(ask)) {}

void BlockedNode::onVerdict(core::Verdict& verdict, ros1::Circumstances& /*circumstances*/) {
  if (!verdict.alarm) {
    step_ = Step::kNone;
  } else if (step_ == Step::kNone && !verdict.suspects.empty()) {
    const core::Suspect& first = verdict.suspects.front();
    step_ = Step::kTold;
    if (isSilence(first.reason.kind)) {
      ask(host_.session()->vocabulary().at(first.id));
    }
  } else if (step_ == Step::kAsked) {
    if (const std::optional<std::set<std::string>> hanging = host_.live().discovery().hanging()) {
      step_ = Step::kTold;
      verdict.note = inWords(*hanging);
      verdict.changed = verdict.changed || !verdict.note.empty();
    }
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

std::string BlockedNode::inWords(const std::set<std::string>& hanging) const {
  const auto hangs = [&](const std::string& node) { return hanging.count(node) > 0; };
  std::vector<std::string> blocking;
  std::copy_if(subscribers_.begin(), subscribers_.end(), std::back_inserter(blocking), hangs);
  if (blocking.empty() || std::any_of(publishers_.begin(), publishers_.end(), hangs)) {
    return "";
  }
  const bool several = blocking.size() > 1;
  return std::string("it answers, but its subscriber") + (several ? "s " : " ") +
         core::listed(blocking, blocking.size()) + (several ? " do not" : " does not");
}

}  // namespace self_awareness
