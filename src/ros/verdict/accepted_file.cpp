#include "accepted_file.h"

#include <algorithm>
#include <cstdint>

#include "one_message_file.h"
#include "self_awareness/Acceptances.h"
#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/ros_time.h"

namespace self_awareness::ros1 {
namespace {

constexpr OneMessageFile kFileOfAccepted{kAcceptedFile, "/accepted",
                                         "what is accepted in it is damaged", 4 << 20};

void checkContent(const self_awareness::Acceptances& accepted) {
  check(accepted.accepted.size() <= core::Acceptances::kMost, "there are too many");
  for (const self_awareness::Acceptance& each : accepted.accepted) {
    const bool is_mode = core::kindOf(each.kind) == core::Kind::kNewMode;
    check(is_mode ? !each.together.empty() : !each.component.empty() || !each.topic.empty(),
          "one names nobody");
    check(is_mode ? each.component.empty() && each.topic.empty() : each.together.empty(),
          "one is of a component and of a mode");
    check(std::max({each.component.size(), each.topic.size(), each.by.size()}) <= kLongestName &&
              std::all_of(each.together.begin(), each.together.end(),
                          [](const std::string& name) { return name.size() <= kLongestName; }),
          "a name is too long");
    check(std::is_sorted(each.together.begin(), each.together.end()),
          "the components of a mode are in no order");
    check(each.kind.empty() || core::kindOf(each.kind).has_value(), "the kind of one is none");
  }
}

}  // namespace

std::string pathOfAccepted(const std::string& model) {
  return model + ".accepted";
}

void writeAccepted(const core::Acceptances& accepted, const std::string& path) {
  self_awareness::Acceptances message;
  std::int64_t latest = 0;
  for (const core::Acceptance& each : accepted.list()) {
    self_awareness::Acceptance& one = message.accepted.emplace_back();
    one.component = each.component;
    one.topic = each.topic;
    one.kind = each.kind ? core::toString(*each.kind) : "";
    one.together = each.together;
    one.at = toRosTime(each.at);
    one.by = each.by;
    latest = std::max(latest, each.at);
  }
  writeOneMessage(kFileOfAccepted, message, toRosTime(latest), path);
}

std::optional<core::Acceptances> readAccepted(const std::string& path) {
  const auto message =
      readOneMessage<self_awareness::Acceptances>(kFileOfAccepted, path, checkContent);
  if (!message) {
    return std::nullopt;
  }
  core::Acceptances accepted;
  for (const self_awareness::Acceptance& one : message->accepted) {
    core::Acceptance each;
    each.component = one.component;
    each.topic = one.topic;
    each.kind = core::kindOf(one.kind);
    each.together = one.together;
    each.at = fromRosTime(one.at);
    each.by = one.by;
    accepted.add(each);
  }
  return accepted;
}

}  // namespace self_awareness::ros1
