#include "log_quotes.h"

#include <cstdint>
#include <optional>

#include "ros/log_line.h"
#include "ros/text.h"

namespace self_awareness {
namespace {

const std::string kLog = "rosgraph_msgs/Log[";

std::string nameOf(std::uint8_t level) {
  switch (level) {
    case 1:
      return "DEBUG";
    case 2:
      return "INFO";
    case 4:
      return "WARN";
    case 8:
      return "ERROR";
    case 16:
      return "FATAL";
    default:
      return "level " + std::to_string(level);
  }
}

}  // namespace

void LogQuotes::add(core::EventId id, const core::EventType& type, const ros1::Content& content) {
  if (type.type.compare(0, kLog.size(), kLog) != 0) {
    return;
  }
  const std::optional<ros1::SaidLine> line = ros1::readLogLine(content.data(), content.size());
  if (line) {
    words_[id] = "logged " + nameOf(line->level) + " \"" + ros1::printable(line->text, kLongest) +
                 (line->text.size() > kLongest ? "...\"" : "\"") +
                 ", and nothing of that level in training";
  }
}

void LogQuotes::onCut(Cut why) {
  if (why == Cut::kOtherModel) {
    words_.clear();
  }
}

void LogQuotes::onVerdict(core::Verdict& verdict, ros1::Circumstances& /*circumstances*/) {
  explain(verdict.suspects);
  explain(verdict.new_suspects);
}

void LogQuotes::explain(std::vector<core::Suspect>& suspects) const {
  for (core::Suspect& suspect : suspects) {
    const auto words = words_.find(suspect.id);
    if (words != words_.end()) {
      suspect.reason.words = words->second;
    }
  }
}

}  // namespace self_awareness
