#include <algorithm>

#include "core/evidence/channel/age.h"
#include "core/evidence/channel/channels.h"
#include "core/evidence/channel/company.h"
#include "core/evidence/channel/frozen.h"
#include "core/evidence/channel/lost.h"
#include "core/evidence/channel/owed.h"
#include "core/evidence/channel/pace.h"
#include "core/evidence/channel/pairs.h"
#include "core/evidence/channel/silence.h"
#include "core/evidence/channel/size.h"
#include "core/evidence/channel/values.h"

namespace self_awareness::core::evidence {

std::vector<const Channel*> channelsOfTheMethod() {
  static const Silence silence;
  static const Pace slower(Pace::Side::kSlower);
  static const Pace faster(Pace::Side::kFaster);
  static const Pairs pairs;
  static const Owed owed;
  static const Company company;
  static const Age age;
  static const Lost lost;
  static const Size size;
  static const Frozen frozen;
  static const Values values;
  return {&silence, &slower, &faster, &pairs,  &owed,  &company,
          &age,     &lost,   &size,   &frozen, &values};
}

std::string channelName(const Track& track) {
  return track.channel->name();
}

std::string channelLabel(const Track& track) {
  return track.channel->label();
}

std::vector<std::string> channelNames() {
  std::vector<std::string> names;
  for (const Channel* channel : channels()) {
    names.push_back(channel->name());
  }
  return names;
}

const Channel* channelNamed(const std::string& name) {
  const auto found = std::find_if(channels().begin(), channels().end(),
                                  [&](const Channel* each) { return each->name() == name; });
  return found == channels().end() ? nullptr : *found;
}

}  // namespace self_awareness::core::evidence
