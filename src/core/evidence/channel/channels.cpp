#include "core/evidence/channel/channels.h"

namespace self_awareness::core::evidence {

const std::vector<const Channel*>& channels() {
  static const std::vector<const Channel*> all = channelsOfTheMethod();
  return all;
}

}  // namespace self_awareness::core::evidence
