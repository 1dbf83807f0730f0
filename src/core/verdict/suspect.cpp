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

/// Seconds, rounded: microseconds after a start mean nothing.
double toMilliseconds(double seconds) {
  return std::round(seconds * 1e3) / 1e3;
}

}  // namespace

std::string describe(const Suspect& suspect) {
  if (!suspect.words.empty()) {
    return suspect.words;
  }
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
    case Suspect::Reason::kNeverHeard:
      std::snprintf(text, sizeof text, "not heard since the start, usually within %.3g to %.3g s",
                    toMilliseconds(suspect.usual_shortest), toMilliseconds(suspect.usual_longest));
      return text;
    default:
      return suspect.words;
  }
}

}  // namespace self_awareness::core
