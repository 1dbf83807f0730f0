#include "self_awareness/core/verdict/alarm.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace self_awareness::core {
namespace {

std::optional<Alarm::Level> levelOf(const Verdict& verdict) {
  if (verdict.alarm) {
    return Alarm::Level::kAlarm;
  }
  return verdict.suspicion ? std::optional(Alarm::Level::kSuspicion) : std::nullopt;
}

Kind kindOf(const Silent& silent) {
  return silent.others_go_on ? Kind::kNewMode : Kind::kAllSilent;
}

std::vector<Suspect> withComponents(std::vector<Suspect> suspects, const Vocabulary& vocabulary) {
  for (Suspect& suspect : suspects) {
    if (suspect.id < vocabulary.size()) {
      const EventType& type = vocabulary.at(suspect.id);
      suspect.topic = type.scope;
      suspect.value = valueOf(type);
      if (suspect.component.empty()) {
        suspect.component = componentOf(type.source, type.scope);
      }
    }
  }
  return suspects;
}

void blame(const Suspect& suspect, Alarm& alarm) {
  for (std::vector<Suspect>* named : {&alarm.suspects, &alarm.later}) {
    for (Suspect& each : *named) {
      each.onset = each.component == suspect.component ? suspect.onset : each.onset;
    }
  }
  alarm.culprit = suspect.component;
  alarm.reason = suspect.reason.words;
  alarm.kind = suspect.reason.kind;
  alarm.note.clear();
  alarm.waiting.clear();
}

/// Whether somebody is to blame rather than the culprit: it was missed before, or was unusual
/// before, and the culprit does not come for that, or is unusual for that.
/// @param now the culprit as it is named now; null: it is not
bool beganEarlier(const Suspect& first, const Suspect& culprit, const Suspect* now) {
  if (isAbsence(first.reason.kind)) {
    return first.missed > 0 && first.missed < culprit.onset;
  }
  return now != nullptr &&
         (isAbsence(culprit.reason.kind) || now->roots.count(first.component) > 0) &&
         first.reason.kind != Kind::kStranger && !isShared(first.reason.kind) &&
         first.component != culprit.component && first.onset > 0 && first.onset < culprit.onset;
}

/// Who is to blame for a suspicion once the machine is busy no more: the first one that is named
/// now, or was meanwhile, for itself; null: nobody.
const Suspect* suspectedFor(const std::vector<Suspect>& suspects, const Alarm& alarm) {
  for (const std::vector<Suspect>* named : {&suspects, &alarm.later}) {
    for (const Suspect& suspect : *named) {
      const Kind kind = suspect.reason.kind;
      if (suspect.abnormal || kind == Kind::kNeverCame || kind == Kind::kUnsubscribed) {
        return &suspect;
      }
    }
  }
  return nullptr;
}

/// Takes in that a culprit has an excuse, that who is dead has none any more, or that who is named
/// before the culprit now was unusual before. Who is to blame is settled when an alarm is raised,
/// and changes for nothing else.
void findCause(const Verdict& verdict, const std::vector<Suspect>& suspects, Alarm& alarm) {
  const bool was_busy = alarm.kind == Kind::kBusyMachine;
  const bool is_excused_no_more = (was_busy && !verdict.busy) ||
                                  (alarm.kind == Kind::kNewMode && !verdict.silent) ||
                                  alarm.kind == Kind::kSlowerClock;  // which nobody is silent for
  const Suspect* culprit = alarm.suspectToBlame();
  const auto named = [&]() -> const Suspect* {
    const auto found = std::find_if(suspects.begin(), suspects.end(), [&](const Suspect& suspect) {
      return suspect.component == alarm.culprit;
    });
    return found != suspects.end() ? &*found : nullptr;
  };
  if (!suspects.empty() && suspects.front().abnormal) {
    const Suspect& first = suspects.front();
    if ((is_excused_no_more && isAbsence(first.reason.kind)) ||
        (culprit != nullptr && beganEarlier(first, *culprit, named()))) {
      blame(first, alarm);
      culprit = alarm.suspectToBlame();
    }
  }
  if (alarm.level == Alarm::Level::kSuspicion && was_busy && !verdict.busy) {
    if (const Suspect* const suspect = suspectedFor(suspects, alarm)) {
      blame(Suspect(*suspect), alarm);
      culprit = alarm.suspectToBlame();
    }
  }
  const bool is_named = named() != nullptr;
  const bool nobody =
      alarm.culprit.empty() && alarm.kind != Kind::kAllSilent && alarm.kind != Kind::kTwoSenders;
  const std::int64_t began = culprit != nullptr ? culprit->onset : alarm.begin;
  if (verdict.busy && verdict.busy->since <= began && (culprit != nullptr ? !is_named : nobody)) {
    alarm.kind = Kind::kBusyMachine;
    alarm.culprit.clear();
    alarm.reason.clear();
  }
  const bool is_silent_with_them = alarm.silent && (!is_named || !alarm.silent->others_go_on) &&
                                   isAbsence(alarm.kind) && alarm.silent->since <= alarm.begin &&
                                   alarm.silent->has(alarm.culprit);
  if (alarm.silent && (alarm.kind == Kind::kAllSilent || alarm.kind == Kind::kNewMode ||
                       (verdict.silent && ((was_busy && !verdict.busy) || is_silent_with_them)))) {
    alarm.kind = kindOf(*alarm.silent);
    alarm.culprit.clear();
    alarm.reason = describe(*alarm.silent);
  }
}

/// Whether what is wrong with a suspect is told better now: on how many topics somebody is there
/// who should not be, or by whose clock, shows with time; who loses messages, or sends too seldom,
/// fell silent for that; and who is fast by the factor of others is so by the clock.
bool isToldBetter(const Suspect& before, const Suspect& now) {
  const Kind kind = now.reason.kind;
  const bool grows = isShared(kind) || !now.reason.topics.empty();
  const bool still_comes = now.abnormal && isAbsence(before.reason.kind) &&
                           (kind == Kind::kLossy || kind == Kind::kSlow);
  const bool is_the_clock = now.component == before.component && kind == Kind::kSlowerClock &&
                            before.reason.kind == Kind::kFast;
  return is_the_clock ||
         (now.id == before.id && (still_comes || (grows && kind == before.reason.kind)));
}

void growWith(const Verdict& verdict, Alarm& alarm) {
  for (std::vector<Suspect>* named : {&alarm.suspects, &alarm.later}) {
    for (Suspect& suspect : *named) {
      for (const Suspect& now : verdict.suspects) {
        if (isToldBetter(suspect, now)) {
          const bool is_to_blame = suspect.component == alarm.culprit || isShared(alarm.kind);
          if (is_to_blame && suspect.reason.kind == alarm.kind) {
            alarm.kind = now.reason.kind;
            alarm.reason = now.reason.words;
          }
          suspect.reason = now.reason;
        }
      }
    }
  }
  if (isShared(alarm.kind)) {
    alarm.culprit.clear();  // as of who has the name of another one
  }
}

}  // namespace

const Suspect* Alarm::suspectToBlame() const {
  for (const std::vector<Suspect>* named : {&suspects, &later}) {
    for (const Suspect& suspect : *named) {
      if (suspect.component == culprit && !culprit.empty()) {
        return &suspect;
      }
    }
  }
  return nullptr;
}

std::optional<Alarm> Alarms::add(const Verdict& verdict, std::int64_t window,
                                 const Vocabulary& vocabulary) {
  const std::int64_t window_end = verdict.window->start + window;
  const std::optional<Alarm::Level> level = levelOf(verdict);
  std::optional<Alarm> ended;
  if (standing_ && standing_->level != level) {
    goOn(verdict, window_end, vocabulary);
    ended = end(window_end);
  }
  if (level) {
    if (!standing_) {
      begin(verdict, window_end, ended);
    }
    goOn(verdict, window_end, vocabulary);
  }
  return ended;
}

std::optional<Alarm> Alarms::end(std::int64_t now) {
  std::optional<Alarm> ended = std::exchange(standing_, std::nullopt);
  if (ended) {
    ended->end = now;
    ended->over = true;
  }
  return ended;
}

void Alarms::resume(Alarm alarm) {
  last_id_ = alarm.id;
  standing_ = std::move(alarm);
}

void Alarms::begin(const Verdict& verdict, std::int64_t end, const std::optional<Alarm>& before) {
  last_id_ = std::max(static_cast<std::uint64_t>(std::max<std::int64_t>(end, 1)), last_id_ + 1);
  Alarm& alarm = standing_.emplace();
  alarm.id = last_id_;
  alarm.level = *levelOf(verdict);
  alarm.begin = end;
  if (before) {  // a suspicion may be what is left of an alarm
    alarm.kind = before->kind;
    alarm.culprit = before->culprit;
    alarm.reason = before->reason;
    if (const Suspect* const culprit = before->suspectToBlame()) {
      alarm.suspects = {*culprit};
    }
  }
}

void Alarms::goOn(const Verdict& verdict, std::int64_t end, const Vocabulary& vocabulary) {
  Alarm& alarm = *standing_;
  const bool stands = alarm.level == levelOf(verdict);
  const std::vector<Suspect> suspects = withComponents(verdict.suspects, vocabulary);
  if (stands && alarm.evidence.empty() && !verdict.evidence.empty()) {
    alarm.evidence = verdict.evidence;
    alarm.suspects = suspects;
    alarm.culprit.clear();
    alarm.reason.clear();
    alarm.kind = verdict.silent ? kindOf(*verdict.silent) : Kind::kOutOfOrder;
    if (!suspects.empty()) {
      blame(suspects.front(), alarm);
    }
  }
  if (stands && !alarm.suspects.empty()) {
    growWith(verdict, alarm);
  }
  if (verdict.busy && !alarm.busy) {
    alarm.busy = verdict.busy;
  }
  if (stands && verdict.silent &&
      (!alarm.silent || verdict.silent->components.size() > alarm.silent->components.size())) {
    alarm.silent = verdict.silent;
  }
  const std::vector<Suspect> later = withComponents(verdict.new_suspects, vocabulary);
  alarm.later.insert(alarm.later.end(), later.begin(), later.end());
  if (stands) {
    findCause(verdict, suspects, alarm);
  }
  if (verdict.waiting.size() > alarm.waiting.size() && !suspects.empty() &&
      suspects.front().component == alarm.culprit) {
    alarm.waiting = verdict.waiting;
  }
  if (!verdict.note.empty()) {
    alarm.note = verdict.note;
  }
  alarm.end = end;
  alarm.lowest_score = std::fmin(alarm.lowest_score, verdict.score.value_or(0));
}

}  // namespace self_awareness::core
