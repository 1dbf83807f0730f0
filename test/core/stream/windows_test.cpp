#include "self_awareness/core/stream/windows.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "self_awareness/core/stream/clock.h"

namespace self_awareness::core {
namespace {

constexpr std::int64_t kWindow = 100 * kNanosecondsPerSecond / 1000;
constexpr EventId kUnknownId = 7;
constexpr EventId kModeId = 8;

// Records what it is told: "1" for an event of type 1, "[start end events]" for a window.
class Told : public WindowObserver {
 public:
  std::optional<ObservedEvent> observe(const Event& event) override {
    told += std::to_string(event.id);
    return event.id == kModeId
               ? std::nullopt
               : std::optional(ObservedEvent{event, event.id == kUnknownId, std::nullopt});
  }
  void close(const Window& window, std::int64_t end) override {
    told += "[" + std::to_string(window.start) + " " + std::to_string(end) + " " +
            std::to_string(window.events.size()) + "]";
    unknown.push_back(window.unknown());
  }
  void onClockStep() override { told += "!"; }

  std::string told;
  std::vector<std::size_t> unknown;
};

TEST(Windows, LieOnTheAbsoluteGridAlsoBeforeTheEpoch) {
  Told told;
  Windows windows(100, told);
  windows.add({-101, 0});
  windows.add({-1, 0});
  windows.finish();
  EXPECT_EQ(told.told, "0[-200 -100 1]0[-100 -1 1]");
  EXPECT_THROW(Windows(0, told), std::invalid_argument);
}

TEST(Windows, AreClosedBeforeTheEventThatEndsThemWhichIsInNoneIfItTellsAMode) {
  Told told;
  Windows windows(100, told);
  windows.add({10, 1});
  windows.add({50, kUnknownId});
  windows.add({310, 2});  // after two windows of silence
  windows.add({290, 3});  // late: its window was closed
  windows.advance(400);
  EXPECT_EQ(told.told, "17[0 100 2][100 200 0][200 300 0]23[300 400 2]");
  EXPECT_EQ(told.unknown, (std::vector<std::size_t>{1, 0, 0, 0}));
  told.told.clear();
  windows.add({410, kModeId});
  windows.add({420, 1});
  windows.add({510, kModeId});
  EXPECT_EQ(told.told, "81[400 500 1]8");
  windows.finish();
  EXPECT_EQ(told.told, "81[400 500 1]8[500 510 0]");
}

TEST(Windows, TheLastOneEndsWithWhatIsKnownUnlessARestartForgetsIt) {
  for (const bool restarts : {false, true}) {
    Told told;
    Windows windows(100, told);
    windows.add({10, 1});
    windows.advance(70);
    if (restarts) {
      windows.restart();
      windows.advance(1000);
    }
    windows.finish();
    windows.finish();
    EXPECT_EQ(told.told, restarts ? "1" : "1[0 70 1]");
    EXPECT_FALSE(windows.lastStamp());
    EXPECT_TRUE(windows.add({-1000 * kWindow, 2})) << "no step: it is the first event";
  }
}

TEST(Windows, AStepOfTheClockStartsANewRecording) {
  for (const std::int64_t step : {-(kLatestEvent + 1), kLongestSilence + 1}) {
    Told told;
    Windows windows(kWindow, told);
    const std::int64_t start = 1000 * kWindow;
    EXPECT_TRUE(windows.add({start, 1}));
    EXPECT_FALSE(windows.add({start + step, 2}));
    EXPECT_EQ(told.told, "1!2") << step;  // the open window is lost
    EXPECT_EQ(windows.lastStamp(), start + step);
  }
}

}  // namespace
}  // namespace self_awareness::core
