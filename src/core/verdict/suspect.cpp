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
      std::snprintf(text, sizeof text, " %.3f s, usually %.3f to %.3f s", suspect.delay,
                    suspect.usual_shortest, suspect.usual_longest);
      return (suspect.other.empty() ? "came after" : "delay after " + suspect.other + ":") + text;
    case Suspect::Reason::kAnswer:
      return "left out too often after " + suspect.other;
  }
  return "";
}

}  // namespace self_awareness::core
