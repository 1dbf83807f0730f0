#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/acceptance.h"

/// What is accepted, for the tests of those that go by it.
namespace self_awareness::core {

/// Of a component and a topic, each a pattern; all that is left out fits.
inline Acceptance accepted(const std::string& component, const std::string& topic = "",
                           std::optional<Kind> kind = std::nullopt) {
  Acceptance acceptance;
  acceptance.component = component;
  acceptance.topic = topic;
  acceptance.kind = kind;
  return acceptance;
}

/// A mode in which these are off together.
inline Acceptance acceptedMode(const std::vector<std::string>& together) {
  Acceptance acceptance = accepted("", "", Kind::kNewMode);
  acceptance.together = together;
  return acceptance;
}

inline Acceptances allOf(std::initializer_list<Acceptance> each) {
  Acceptances all;
  for (const Acceptance& acceptance : each) {
    all.add(acceptance);
  }
  return all;
}

}  // namespace self_awareness::core
