#pragma once

#include <string>

#include "ros/verdict/alarm_state.h"
#include "self_awareness/core/verdict/alarm.h"

namespace self_awareness {

class LiveSource;
class Session;
struct MonitorParameters;

/// The monitor, for parts that ask it for more than they are told.
class Host {
 public:
  /// The model at work; null: there is none.
  virtual Session* session() = 0;
  virtual const MonitorParameters& parameters() const = 0;
  virtual const LiveSource& live() const = 0;
  /// What stands.
  virtual const ros1::AlarmState& alarm() const = 0;
  /// Why nothing is told of a component, in words; empty: it is.
  virtual std::string mutedBy(const std::string& component) const = 0;

  /// Says that what stood is over, although no window brought that about.
  virtual void standDown(const std::string& message) = 0;
  /// Something was unusual, and is over, without an alarm or a suspicion.
  virtual void nearMiss(const core::Alarm& alarm) = 0;
  /// What is heard now is not normal operation. @param why in words
  virtual void notNormal(const std::string& why) = 0;
  /// Has /diagnostics say now how things are.
  virtual void report() = 0;

 protected:
  ~Host() = default;
};

}  // namespace self_awareness
