#include "log_quotes.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/exception.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "ros/bag/log_lines.h"
#include "ros/text.h"

namespace self_awareness {
namespace {

const std::string kLog = "rosgraph_msgs/Log[";
const std::string kDiagnostics = "diagnostic_msgs/DiagnosticArray[lists status.level";

const std::map<int, std::string> kLevels{
    {1, "DEBUG"}, {2, "INFO"}, {4, "WARN"}, {8, "ERROR"}, {16, "FATAL"}};

std::string nameOf(std::uint8_t level) {
  const auto known = kLevels.find(level);
  return known == kLevels.end() ? "level " + std::to_string(level) : known->second;
}

std::string quoted(const std::string& text) {
  return '"' + ros1::shortened(text, LogQuotes::kLongest) + '"';
}

/// What the worst status of a message says; empty: the message cannot be read, or has none.
std::string worstOf(const ros1::Content& content) {
  diagnostic_msgs::DiagnosticArray message;
  try {
    std::vector<std::uint8_t> bytes(content.begin(), content.end());  // the stream is not const
    ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::deserialize(stream, message);
  } catch (const ros::Exception&) {
    return "";
  }
  const auto worst =
      std::max_element(message.status.begin(), message.status.end(),
                       [](const auto& one, const auto& other) { return one.level < other.level; });
  return worst == message.status.end() ? "" : worst->name + ": " + worst->message;
}

}  // namespace

void LogQuotes::add(core::EventId id, const core::EventType& type, const ros1::Content& content) {
  if (type.type.compare(0, kDiagnostics.size(), kDiagnostics) == 0) {
    if (const std::string worst = worstOf(content); !worst.empty()) {
      words_[id] = type.source + " says on " + type.scope + " " + quoted(worst) +
                   ", and nothing so bad in training";
    }
    return;
  }
  const std::optional<ros1::LogLine> line = type.type.compare(0, kLog.size(), kLog) == 0
                                                ? ros1::readLogLine(content.data(), content.size())
                                                : std::nullopt;
  if (line) {
    words_[id] = type.source + " logged " + nameOf(line->level) + " " + quoted(line->text) +
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
