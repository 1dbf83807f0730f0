#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "self_awareness/Accept.h"
#include "self_awareness/Incidents.h"
#include "self_awareness/core/stream/vocabulary.h"
#include "self_awareness/core/verdict/acceptance.h"
#include "self_awareness/core/verdict/alarm.h"
#include "self_awareness/ros/encoding.h"

namespace self_awareness {

/// What a call of ~accept may refer to.
struct Acceptable {
  std::optional<core::Alarm> alarm;  ///< that stands; none: nothing does
  const self_awareness::Incidents& incidents;
  const core::Vocabulary& vocabulary;  ///< that the ids of the alarm's suspects are of
  /// Events that training never saw and nobody has accepted, by their ids.
  std::map<core::EventId, std::uint64_t> unknown;
  const ros1::Encoder& encoder;  ///< that knows by what names events call nodes and topics
  std::int64_t now;              ///< ROS time [ns]
};

/// What a call of ~accept asks for.
struct WantedAcceptances {
  std::vector<core::Acceptance> asked;  ///< without a time and a caller
  std::vector<std::string> refused;     ///< of several, who, and why
};

/// Whether a call names nothing, and so asks what it may name.
bool asksWhat(const Accept::Request& request);
/// What a call may name now, as it is typed: of what stands, of who is new, of incidents; or what
/// is accepted, to take it back.
std::string offerOf(const Accept::Request& request, const Acceptable& acceptable,
                    const core::Acceptances& accepted);

/// Reads a call that names something.
/// @param accepted what is accepted so far: to take it back, its names are known
/// @throw std::invalid_argument says what is wrong with the request: there is nothing that it may
/// ask for
WantedAcceptances requestOf(const Accept::Request& request, const Acceptable& acceptable,
                            const core::Acceptances& accepted);

/// "/driver on /scan (silent)".
std::string inWordsOf(const core::Acceptance& acceptance);
/// The same of several: of so many, and how many more there are.
constexpr std::size_t kMostNamed = 20;
std::string inWordsOf(const std::vector<core::Acceptance>& all);
/// Whether it is about an event type, or about who sends it.
bool concerns(const core::Acceptance& acceptance, const core::EventType& type);
/// Whether it is about somebody who was heard, or whom the model knows.
bool isKnown(const core::Acceptance& acceptance, const core::Vocabulary& vocabulary);

}  // namespace self_awareness
