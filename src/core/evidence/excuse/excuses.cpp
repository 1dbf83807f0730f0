#include "core/evidence/excuse/excuses.h"

#include <algorithm>
#include <optional>

#include "core/evidence/excuse/busy_machine.h"
#include "core/evidence/excuse/new_mode.h"
#include "core/evidence/excuse/silent_together.h"
#include "core/evidence/excuse/slower_clock.h"

namespace self_awareness::core::evidence {

bool beganSince(std::int64_t since, const Excess& excess, const Model& model) {
  return excess.onset + (excess.isTooLittle() ? model.longestPause(excess.id) : 0) >= since;
}

void Excuses::closeWindow(std::vector<Excess>& excesses, const Unusual& window,
                          Judgement& judgement) {
  for (const std::unique_ptr<Excuse>& excuse : list_) {
    const std::optional<std::int64_t> since = excuse->closeWindow(window, judgement);
    if (!since) {
      continue;
    }
    for (Excess& excess : excesses) {
      if (beganSince(*since, excess, *model_) && excuse->explains(excess, window)) {
        excess.excused = std::min(excess.excused, excuse->reason());
      }
    }
  }
  if (judgement.busy && judgement.silent && judgement.silent->others_go_on) {
    judgement.silent.reset();  // whom a busy machine holds up
  }
}

void Excuses::accept(const Acceptances& accepted) {
  for (const std::unique_ptr<Excuse>& excuse : list_) {
    excuse->accept(accepted);
  }
}

void Excuses::restart() {
  for (const std::unique_ptr<Excuse>& excuse : list_) {
    excuse->restart();
  }
}

Excuses::List allExcuses(const std::shared_ptr<const Model>& model,
                         const std::shared_ptr<const SourceGraph>& graph) {
  Excuses::List list;
  // First, since what is accepted makes no machine busy.
  list.push_back(std::make_unique<NewMode>(model));
  list.push_back(std::make_unique<SilentTogether>(model, graph));
  list.push_back(std::make_unique<SlowerClock>(model));
  list.push_back(std::make_unique<BusyMachine>(model));
  return list;
}

}  // namespace self_awareness::core::evidence
