#include "self_awareness/core/verdict/suspect.h"

#include <cmath>
#include <cstdio>

namespace self_awareness::core {
namespace {

std::string usualGap(const Suspect& suspect) {
  char text[80];
  if (std::isnan(suspect.usual_gap)) {
    std::snprintf(text, sizeof text, "usually every %.3f to %.3f s", suspect.usual_shortest,
                  suspect.usual_longest);
  } else {
    std::snprintf(text, sizeof text, "usually every %.3f s, at most %.3f s", suspect.usual_gap,
                  suspect.longest_gap);
  }
  return text;
}

// Seconds of a small time in the unit that shows it.
std::string inMilliseconds(double seconds) {
  char text[40];
  if (seconds < 1) {
    std::snprintf(text, sizeof text, seconds < 0.1 ? "%.1f ms" : "%.0f ms", 1000 * seconds);
  } else {
    std::snprintf(text, sizeof text, "%.2f s", seconds);
  }
  return text;
}

// "7 times of 9 after /a /x T in the last 3.2 s"
std::string timesOf(const Suspect& suspect) {
  char text[80];
  std::snprintf(text, sizeof text, "%zu time%s of %zu", suspect.times,
                suspect.times == 1 ? "" : "s", suspect.of);
  std::string times = text;
  if (!suspect.other.empty()) {
    times += " after " + suspect.other;
  }
  std::snprintf(text, sizeof text, " in the last %.1f s", suspect.lasted);
  return times + text;
}

std::string describeDelay(const Suspect& suspect) {
  if (suspect.times == 0) {
    return "at unusual delays" + (suspect.other.empty() ? "" : " after " + suspect.other);
  }
  const double later = suspect.delay - suspect.usual_delay;
  const bool scattered = !std::isnan(suspect.scatter);
  char usual[60];
  std::snprintf(usual, sizeof usual, ", usually %s%.3f s", suspect.other.empty() ? "every " : "",
                suspect.usual_delay);
  return inMilliseconds(scattered ? suspect.scatter : std::abs(later)) +
         (scattered   ? " earlier or later"
          : later > 0 ? " later"
                      : " earlier") +
         " than usual " + timesOf(suspect) + usual;
}

/// Seconds, rounded: microseconds after a start mean nothing.
double toMilliseconds(double seconds) {
  return std::round(seconds * 1e3) / 1e3;
}

std::string describeAnswer(const Suspect& suspect) {
  if (suspect.of == 0) {
    return "left out too often after " + suspect.other;
  }
  char usual[40] = "never";
  if (suspect.usual_share > 0) {
    const double one_in = 1 / suspect.usual_share;
    std::snprintf(usual, sizeof usual, one_in < 9.95 ? "1 in %.2g" : "1 in %.0f", one_in);
  }
  return "left out " + timesOf(suspect) + ", usually " + usual;
}

}  // namespace

std::string describe(const Suspect& suspect) {
  char text[160];
  switch (suspect.reason) {
    case Suspect::Reason::kSilent:
      std::snprintf(text, sizeof text, "silent for %.2f s, ", suspect.silence);
      return text + usualGap(suspect);
    case Suspect::Reason::kLate:
      std::snprintf(text, sizeof text, "came after %.2f s, ", suspect.silence);
      return text + usualGap(suspect);
    case Suspect::Reason::kUnknown:
      if (suspect.events == 0) {
        std::snprintf(text, sizeof text, "never seen in training, the last one %.1f s ago",
                      suspect.silence);
        return text;
      }
      std::snprintf(text, sizeof text, "never seen in training, %zu in this window",
                    suspect.events);
      return text;
    case Suspect::Reason::kUnusual:
      std::snprintf(text, sizeof text,
                    "at unusual delays after the others: score %.3g, usually about %.3g",
                    suspect.score, suspect.usual_score);
      return text;
    case Suspect::Reason::kRate:
      std::snprintf(text, sizeof text, "%zu in the last 2 s, usually %.0f to %.0f", suspect.events,
                    suspect.usual_fewest, suspect.usual_most);
      return text;
    case Suspect::Reason::kDelay:
      return describeDelay(suspect);
    case Suspect::Reason::kAnswer:
      return describeAnswer(suspect);
    case Suspect::Reason::kUnanswered:
      if (suspect.of > 0) {
        std::snprintf(text, sizeof text, "has not come after the last %zu ", suspect.of);
      } else {
        std::snprintf(text, sizeof text, "has not come for %.2f s after ", suspect.silence);
      }
      return text + suspect.other;
    case Suspect::Reason::kNeverHeard:
      std::snprintf(text, sizeof text, "not heard since the start, usually within %.3g to %.3g s",
                    toMilliseconds(suspect.usual_shortest), toMilliseconds(suspect.usual_longest));
      return text;
  }
  return "";
}

}  // namespace self_awareness::core
