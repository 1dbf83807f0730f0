#include "core/evidence/presence/unsubscribed.h"

#include <algorithm>
#include <utility>

#include "core/evidence/count/starts.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kMostTopics = 3;  // that are named of a component

}  // namespace

Unsubscribed::Unsubscribed(const Model& model)
    : start_time_(toNanoseconds(model.tuning().start_time)) {
  std::vector<Span> spans;
  for (const Statistics::Recording& recording : model.statistics().recordings()) {
    spans.push_back({recording.start, recording.end, recording.robot_start});
  }
  starts_ = numberOfStarts(spans, start_time_);
  for (EventId id = 0; id < model.size(); ++id) {
    if (!model.vocabulary().tellsMode(id)) {
      ids_.try_emplace(model.component(id), id);
    }
  }
}

void Unsubscribed::set(const std::set<SourceGraph::Subscription>& missing) {
  std::map<SourceGraph::Subscription, Missing> now;
  for (const SourceGraph::Subscription& each : missing) {
    const auto before = missing_.find(each);
    now[each].since = before == missing_.end() ? std::nullopt : before->second.since;
  }
  missing_ = std::move(now);
  update();
}

void Unsubscribed::accept(const Acceptances& accepted) {
  accepted_ = accepted;
  update();
}

void Unsubscribed::update() {
  for (auto& [subscription, missing] : missing_) {
    missing.accepted =
        accepted_.covers(subscription.first, subscription.second, Kind::kUnsubscribed);
  }
  late_ = 0;  // for the next window to say
}

void Unsubscribed::restart() {
  for (auto& [subscription, missing] : missing_) {
    missing.since.reset();
  }
  late_ = 0;
  suspects_.clear();
}

void Unsubscribed::closeWindow(std::int64_t end) {
  std::map<std::string, std::vector<std::string>> late;
  std::size_t number = 0;
  for (auto& [subscription, missing] : missing_) {
    missing.since = missing.since.value_or(end);
    if (!missing.accepted && end - *missing.since > start_time_) {
      late[subscription.first].push_back(subscription.second);
      ++number;
    }
  }
  if (number > 0 && number == late_) {
    return;  // the suspects are those of the window before
  }
  late_ = number;
  suspects_.clear();
  for (const auto& [component, topics] : late) {
    if (ids_.count(component) > 0) {
      suspects_.push_back(suspect(component, topics));
      Suspect& suspect = suspects_.back();
      suspect.onset = end;
      for (const std::string& topic : topics) {
        suspect.onset = std::min(suspect.onset, *missing_.at({component, topic}).since);
      }
    }
  }
}

Suspect Unsubscribed::suspect(const std::string& component,
                              const std::vector<std::string>& topics) const {
  Suspect suspect;
  suspect.id = ids_.at(component);
  suspect.component = component;
  suspect.reason.kind = Kind::kUnsubscribed;
  suspect.reason.topics = topics;
  std::string& words = suspect.reason.words;
  for (std::size_t k = 0; k < std::min(topics.size(), kMostTopics); ++k) {
    words += (k > 0 ? ", " : "does not subscribe to ") + topics[k];
  }
  if (topics.size() > kMostTopics) {
    words += " and " + std::to_string(topics.size() - kMostTopics) + " more";
  }
  words += ", as it did in all " + std::to_string(starts_) + " starts";
  return suspect;
}

}  // namespace self_awareness::core::evidence
