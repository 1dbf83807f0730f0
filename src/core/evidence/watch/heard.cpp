#include "core/evidence/watch/heard.h"

namespace self_awareness::core::evidence {

Heard::Heard(std::size_t types, std::int64_t window, Stalls stalls, const Tuning& tuning)
    : window_(window),
      stalls_(stalls),
      starvation_(tuning),
      longest_stall_(toNanoseconds(tuning.longest_stall)),
      stamps_(types, 0),
      numbers_(types, 0),
      paused_before_(types, 0) {}

void Heard::hear(const Waiting& waiting) {
  if (number_ == 0 || waiting.from < start_) {
    return;  // what was before is in no recording of events
  }
  if (waiting.stoodStill()) {
    pause_ = {waiting.to, pause_.all, pause_.all + waiting.waited};
    stalls_.passTo(waiting.to);
  } else {
    starvation_.add(waiting);
  }
}

void Heard::restart() {
  stalls_.restart();
  starvation_.restart();
  mode_.restart();
  stamps_.assign(stamps_.size(), 0);
  numbers_.assign(stamps_.size(), 0);
  paused_before_.assign(stamps_.size(), 0);
  pause_ = {};
  number_ = 0;
}

void Heard::closeWindow(std::int64_t end) {
  window_end_ = end;
  stalls_.closeWindow(end, number_ > 0);
}

}  // namespace self_awareness::core::evidence
