#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace self_awareness::core::evidence {

/// Every number of the evidence detector's method (docs/method.md, section 8). They are part of a
/// trained model: who judges by it uses the numbers that it was trained with. A robot's user
/// changes none of them; `evaluate` does, to measure what each is worth
/// (docs/evaluation/research.md). tuningNumbers() has the meaning, the unit and the range of each.
/// Times are in seconds.
struct Tuning {
  // What is known well enough to be judged.
  double fewest_gaps = 8;
  double fewest_starts = 3;
  double deadlines = 3;

  // Which relations have a reason.
  double least_gain = 0.3;
  double least_gain_left = 0.7;
  double chance = 0.1;
  double least_chance_misses = 0.2;
  double most_unusual = 0.5;
  double least_of_longest = 0.1;

  // The evidence of gaps and delays.
  double least_told = 100;
  double least_sum = 9;
  double hours_of_chance = 1000;
  double usual = 0.9;
  double least_effect = 0.005;
  double most_of_limit = 1.5;
  double arming_events = 30;
  double gone_gaps = 5;
  double accept_after = 60;

  // Who never came.
  double start_time = 60;

  // A machine that stands still, or is busy.
  double shortest_stall = 0.05;
  double longest_stall = 0.7;
  double between_stalls = 30;
  double starved = 0.5;
  double usual_load_time = 600;
  double several = 4;
  double busy_one_in = 3;

  // From what recordings show to limits.
  double shortest_part = 30;
  double least_time = 50;
  double margin = 2;
  double margin_of_waiting = 4;
  double margin_of_silence = 1.25;
  double regular = 1.5;
  double fast = 2;
  double pauses = 10;
  double talking = 0.75;
  double usual_spread = 0.6;
  double least_requests = 3;
  double owed_of_silence = 0.9;
  double most_mean_gaps = 3;

  // From evidence to an alarm, and to who is to blame.
  double rare = 0.02;
  double near_limit = 0.75;
  double least_share = 0.3;

  // The attributes of messages.
  double least_lateness = 0.5;
  double least_size = 1;
  double least_repeat = 2;
  double changing_time = 7200;
  double most_values = 16;

  /// Channels that are switched off, by their names (channelNames()).
  std::set<std::string> without;

  /// @throw std::invalid_argument names what is out of its range
  void validate() const;
  /// Whether so many delays of training say what is usual: each speaks against another one by half
  /// of log 2, or more.
  bool areEnough(std::uint64_t delays) const {
    return static_cast<double>(delays) >= 2 * least_told;
  }
  bool isOn(const std::string& channel) const { return without.count(channel) == 0; }
};

bool operator==(const Tuning& a, const Tuning& b);
inline bool operator!=(const Tuning& a, const Tuning& b) {
  return !(a == b);
}

/// What is known of a number of the method.
struct TuningNumber {
  std::string name;
  double Tuning::*value = nullptr;
  double least = 0;           ///< smallest value that makes sense
  double most = 0;            ///< largest one
  std::string unit;           ///< empty: a pure number
  std::string meaning;        ///< a sentence
  std::optional<double> off;  ///< with which the rule that it belongs to is switched off

  bool isValid(double number) const { return number >= least && number <= most; }
};

/// All numbers, in the order of Tuning.
const std::vector<TuningNumber>& tuningNumbers();
/// A number by its name.
/// @throw std::invalid_argument if there is none of this name
const TuningNumber& tuningNumber(const std::string& name);
/// Sets a number.
/// @throw std::invalid_argument if there is none of this name, or the value is out of its range
void set(Tuning& tuning, const std::string& name, double value);

}  // namespace self_awareness::core::evidence
