#include "ros/verdict/announcer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "../../times.h"

namespace self_awareness::ros1 {
namespace {

core::Suspect silent(core::EventId id, std::int64_t onset, std::int64_t missed) {
  core::Suspect suspect;
  suspect.id = id;
  suspect.abnormal = true;
  suspect.onset = onset;
  suspect.missed = missed;
  return suspect;
}

TEST(Announcer, SaysThatAnotherOneIsToBlame) {
  const core::Vocabulary vocabulary({{"/a", "/x", "T"}, {"/b", "/y", "T"}});
  std::vector<std::string> alarms;
  int diagnostics = 0;
  Announcer announcer(
      {[](const self_awareness::SelfAwareness&) {},
       [&](const self_awareness::SelfAwareness& alarm) { alarms.push_back(alarm.component); },
       [&] { ++diagnostics; }});
  core::Window window{kStart, {}};
  core::Verdict verdict;
  verdict.window = &window;
  verdict.alarm = verdict.abnormal = verdict.changed = true;
  verdict.evidence = "overdue";
  const core::Suspect first = silent(0, kStart - kWindow, kStart);
  verdict.suspects = {first};
  announcer.add(verdict, vocabulary, kWindow);
  verdict.changed = false;
  announcer.add(verdict, vocabulary, kWindow);
  EXPECT_EQ(alarms, (std::vector<std::string>{"/a"}));
  verdict.suspects = {silent(1, kStart - 9 * kWindow, kStart - 2 * kWindow), first};
  verdict.new_suspects = {verdict.suspects[0]};
  announcer.add(verdict, vocabulary, kWindow);
  EXPECT_EQ(alarms, (std::vector<std::string>{"/a", "/b"}));
  EXPECT_EQ(diagnostics, 2);
}

}  // namespace
}  // namespace self_awareness::ros1
