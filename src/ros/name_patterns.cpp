#include "name_patterns.h"

#include <algorithm>
#include <stdexcept>

#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kLongestQuotedPattern = 200;  // of a pattern in an error [bytes]

}  // namespace

NamePatterns::NamePatterns(const std::vector<std::string>& patterns) {
  re2::RE2::Options options;
  options.set_log_errors(false);
  options.set_max_mem(kMostMemory);
  int states = 0;
  for (const std::string& pattern : patterns) {
    if (!isPrintable(pattern)) {
      throw std::invalid_argument("encoding: '" + printable(pattern, kLongestQuotedPattern) +
                                  "' is no UTF-8, or has control characters; no name has any");
    }
    auto compiled = std::make_unique<const re2::RE2>(pattern, options);
    if (!compiled->ok()) {
      throw std::invalid_argument("encoding: '" + printable(pattern, kLongestQuotedPattern) +
                                  "' is not a regular expression (of RE2): " +
                                  printable(compiled->error(), kLongestQuotedPattern));
    }
    states += compiled->ProgramSize();
    if (states > kMostStates) {
      throw std::invalid_argument("encoding: its patterns are too large together");
    }
    patterns_.push_back(std::move(compiled));
  }
}

std::size_t NamePatterns::firstThatMatches(const std::string& name) const {
  const auto first = std::find_if(patterns_.begin(), patterns_.end(),
                                  [&](const auto& pattern) { return matches(*pattern, name); });
  return static_cast<std::size_t>(first - patterns_.begin());
}

bool NamePatterns::matches(const re2::RE2& pattern, const std::string& name,
                           re2::StringPiece* groups, int wanted) {
  const auto from = [&](std::size_t begin) {
    return pattern.Match(name, begin, name.size(), re2::RE2::ANCHOR_BOTH, groups, wanted);
  };
  return from(0) || (!name.empty() && name[0] == '/' && from(1));
}

}  // namespace self_awareness::ros1
