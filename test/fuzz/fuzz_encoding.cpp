// Compiles the patterns of an encoding, and matches names: both may be a stranger's. The input is
// one line after the other: patterns, rules to rename (PATTERN>NAME), and the last line a name.

#include <sstream>
#include <stdexcept>
#include <string>

#include "self_awareness/ros/encoding.h"
#include "self_awareness/ros/stable_name.h"

using namespace self_awareness;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ros1::EncodingRules rules;
  std::istringstream lines(std::string(data, data + size));
  std::string line;
  while (std::getline(lines, line)) {
    if (const std::size_t arrow = line.find('>'); arrow != std::string::npos) {
      rules.renames.push_back({line.substr(0, arrow), line.substr(arrow + 1)});
      continue;
    }
    rules.exclude_sources.push_back(line);
    rules.include_topics.push_back(line);
  }
  ros1::Connection connection = ros1::connectionFrom({{"callerid", line}, {"type", line}}, line);
  try {
    const ros1::Encoder encoder(rules, [](const core::EventType&) { return 0; });
    encoder.includesTopic("/" + line);
    encoder.connect(connection);
    ros1::stableName(connection.callerid);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
