#include "self_awareness/core/evidence/tuning.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace self_awareness::core::evidence {

const std::vector<TuningNumber>& tuningNumbers() {
  static const std::vector<TuningNumber> numbers{
      {"fewest_gaps", &Tuning::fewest_gaps, 2, 1e6, "",
       "Gaps that an event type needs to be judged.", std::nullopt},
      {"fewest_starts", &Tuning::fewest_starts, 1, 1e6, "starts",
       "Starts that say what is always, or never, so.", std::nullopt},
      {"deadlines", &Tuning::deadlines, 0, 1000, "",
       "Event types that another one owes an answer, or pauses with, at most.", 0},
      {"least_gain", &Tuning::least_gain, 0, 100, "nat",
       "What delays must say beyond chance to be watched.", std::nullopt},
      {"least_gain_left", &Tuning::least_gain_left, -100, 1, "",
       "Share of that gain that every part of a recording must show.", -100},
      {"chance", &Tuning::chance, 1e-9, 1, "",
       "Chance of a relation that something speaks for; else that of all together.", std::nullopt},
      {"least_chance_misses", &Tuning::least_chance_misses, 0, 1, "",
       "Share of the answers that must be missing by chance of who neither pauses nor is asked.",
       std::nullopt},
      {"most_unusual", &Tuning::most_unusual, 0, 1, "",
       "Share of the requests without an answer, or of the messages with a value, at most.",
       std::nullopt},
      {"least_of_longest", &Tuning::least_of_longest, 0, 1, "",
       "Share of the longest usual answer that the shortest must take, else the two come in any "
       "order.",
       0},
      {"least_told", &Tuning::least_told, 0, 1e6, "nat",
       "How much gaps or delays of training speak against others; else those of now have to.", 0},
      {"least_sum", &Tuning::least_sum, 1e-3, 1e3, "nat",
       "Least limit of a sum of what gaps, delays or values say.", std::nullopt},
      {"hours_of_chance", &Tuning::hours_of_chance, 1e-3, 1e9, "h",
       "What chance does once in so long is below the limits of losses, values and same contents.",
       std::nullopt},
      {"usual", &Tuning::usual, 0.01, 0.999, "", "Share of the delays in training that are usual.",
       std::nullopt},
      {"least_effect", &Tuning::least_effect, 0, 1e3, "s", "A change of a delay that is no fault.",
       std::nullopt},
      {"most_of_limit", &Tuning::most_of_limit, 1, 1e9, "", "Times its limit at which a sum ends.",
       std::nullopt},
      {"arming_events", &Tuning::arming_events, 1, 1e6, "",
       "Events in a row as in training that arm a relation.", 1},
      {"gone_gaps", &Tuning::gone_gaps, 0, 1e9, "longest gaps",
       "After so long a gap a component was restarted.", 1e9},
      {"accept_after", &Tuning::accept_after, 1e-3, 1e9, "s",
       "What is different, or starved, for so long is no news any more.", 1e9},
      {"start_time", &Tuning::start_time, 0, 1e9, "s",
       "Time after the start in which answers are not owed by who was not heard yet.",
       std::nullopt},
      {"shortest_stall", &Tuning::shortest_stall, 0, 1e3, "s", "A stall lasts at least so long.",
       std::nullopt},
      {"longest_stall", &Tuning::longest_stall, 0, 1e3, "s", "And at most so long.", 0},
      {"between_stalls", &Tuning::between_stalls, 0, 1e9, "s",
       "Time in which one stall is forgiven.", std::nullopt},
      {"starved", &Tuning::starved, 0, 2, "",
       "Share of the time, beyond the usual one, for which processes wait while the machine is "
       "starved.",
       2},
      {"usual_load_time", &Tuning::usual_load_time, 1, 1e9, "s",
       "Time that this usual share is the mean of.", std::nullopt},
      {"several", &Tuning::several, 1, 1e6, "",
       "Components that are late, or silent, or hear a topic, all for one reason.", 1e6},
      {"busy_one_in", &Tuning::busy_one_in, 1, 1e6, "", "One of so many components must be late.",
       std::nullopt},
      {"shortest_part", &Tuning::shortest_part, 1, 1e6, "s",
       "A shorter part of a recording is no sample.", std::nullopt},
      {"least_time", &Tuning::least_time, 1e-3, 1e6, "s", "Normal operation that limits need.",
       std::nullopt},
      {"margin", &Tuning::margin, 1, 1e3, "",
       "Times the largest evidence that was seen that a limit is.", std::nullopt},
      {"margin_of_waiting", &Tuning::margin_of_waiting, 1, 1e3, "",
       "The same of who owes an answer, or pauses with others.", std::nullopt},
      {"margin_of_silence", &Tuning::margin_of_silence, 1, 1e3, "",
       "Times the longest gap, and a window, that a silence may last.", std::nullopt},
      {"regular", &Tuning::regular, 1, 1e3, "mean gaps",
       "A timer that lost nothing has shorter gaps.", std::nullopt},
      {"fast", &Tuning::fast, 0, 1e9, "windows",
       "Of a timer with a shorter mean gap, a loss is like a hiccup of the host.", 0},
      {"pauses", &Tuning::pauses, 1, 32, "gaps",
       "Longest gaps that say how long a silence may get, at most.", std::nullopt},
      {"talking", &Tuning::talking, 0, 1, "",
       "Share of the time in which who never pauses is heard.", 0},
      {"usual_spread", &Tuning::usual_spread, 1e-3, 1e3, "nat",
       "By so much the longest pauses of starts differ, before a robot's say by how much.",
       std::nullopt},
      {"least_requests", &Tuning::least_requests, 0, 1e6, "messages",
       "Least limit of what goes on without its company.", std::nullopt},
      {"owed_of_silence", &Tuning::owed_of_silence, 0, 1e9, "",
       "Share of its longest silence that an answer may have stayed away for, at most.", 1e9},
      {"most_mean_gaps", &Tuning::most_mean_gaps, 0, 1e9, "mean gaps",
       "Who has longer gaps pauses.", std::nullopt},
      {"rare", &Tuning::rare, 1e-9, 0.5, "",
       "Share, or probability, below which something is next to never so.", std::nullopt},
      {"near_limit", &Tuning::near_limit, 0, 1, "limits",
       "Evidence from which on a silence is named.", std::nullopt},
      {"least_share", &Tuning::least_share, 0, 1, "limits", "Evidence that says who is involved.",
       std::nullopt},
      {"least_lateness", &Tuning::least_lateness, 1e-3, 1e6, "s",
       "Least limit of an answer that is owed, and of stamps that are older than usual.",
       std::nullopt},
      {"least_size", &Tuning::least_size, 0.01, 100, "octaves",
       "Least limit of how far sizes may lie beyond all in training.", std::nullopt},
      {"least_repeat", &Tuning::least_repeat, 0.01, 1e6, "s",
       "Least limit of the time with the same content.", std::nullopt},
      {"changing_time", &Tuning::changing_time, 0, 1e9, "s",
       "Time for which training must have heard contents change, to miss that.", 1e9},
      {"most_values", &Tuning::most_values, 0, 1e6, "",
       "Values of a topic, at most: who has more says what it likes.", 0},
  };
  return numbers;
}

const TuningNumber& tuningNumber(const std::string& name) {
  const auto& numbers = tuningNumbers();
  const auto found = std::find_if(numbers.begin(), numbers.end(),
                                  [&](const TuningNumber& each) { return each.name == name; });
  if (found == numbers.end()) {
    throw std::invalid_argument("the method has no number '" + name +
                                "'; 'info --tuning' of a model names them all");
  }
  return *found;
}

void set(Tuning& tuning, const std::string& name, double value) {
  const TuningNumber& number = tuningNumber(name);
  if (!number.isValid(value)) {
    std::ostringstream problem;
    problem << name << " must be from " << number.least << " to " << number.most
            << (number.unit.empty() ? "" : " ") << number.unit << ", not " << value;
    throw std::invalid_argument(problem.str());
  }
  tuning.*number.value = value;
}

void Tuning::validate() const {
  Tuning checked;
  for (const TuningNumber& number : tuningNumbers()) {
    set(checked, number.name, this->*number.value);
  }
}

bool operator==(const Tuning& a, const Tuning& b) {
  return a.without == b.without &&
         std::all_of(tuningNumbers().begin(), tuningNumbers().end(),
                     [&](const TuningNumber& each) { return a.*each.value == b.*each.value; });
}

}  // namespace self_awareness::core::evidence
