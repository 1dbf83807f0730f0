#include "announcer.h"

#include <utility>

namespace self_awareness::ros1 {

Announcer::Announcer(Handlers handlers) : handlers_(std::move(handlers)) {}

void Announcer::add(const core::Verdict& verdict, const core::Vocabulary& vocabulary,
                    std::int64_t window, const Circumstances& circumstances) {
  const auto cause = [this] {
    const self_awareness::SelfAwareness& said = alarm_.message();
    return std::pair(said.kind, said.component);
  };
  const auto before = cause();
  alarm_.add(verdict, vocabulary, window, circumstances);
  handlers_.on_status(alarm_.message());
  if (verdict.changed || (alarm_.stands() && cause() != before)) {
    handlers_.on_alarm(alarm_.message());
    handlers_.on_diagnostics();
  }
}

void Announcer::resume(const self_awareness::StandingAlarm& before,
                       std::vector<core::Suspect> suspects) {
  alarm_.resume(before, std::move(suspects));
  handlers_.on_alarm(alarm_.message());
}

void Announcer::standDown(const std::string& message, std::int64_t now) {
  if (alarm_.standDown(message, now)) {
    handlers_.on_alarm(alarm_.message());
  }
  handlers_.on_diagnostics();
}

}  // namespace self_awareness::ros1
