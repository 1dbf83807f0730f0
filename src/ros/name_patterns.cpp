#include "name_patterns.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr int kMostGroups = 10;  // the whole name, and \1 to \9

std::vector<std::string> patternsOf(const std::vector<Rename>& renames) {
  std::vector<std::string> patterns;
  for (const Rename& rename : renames) {
    patterns.push_back(rename.pattern);
  }
  return patterns;
}

}  // namespace

NamePatterns::NamePatterns(const std::vector<std::string>& patterns) {
  re2::RE2::Options options;
  options.set_log_errors(false);
  options.set_max_mem(kMostMemory);
  int states = 0;
  for (const std::string& pattern : patterns) {
    if (!isPrintable(pattern)) {
      throw std::invalid_argument("encoding: " + quote(pattern) +
                                  " is no UTF-8, or has control characters; no name has any");
    }
    auto compiled = std::make_unique<const re2::RE2>(pattern, options);
    if (!compiled->ok()) {
      throw std::invalid_argument(
          "encoding: " + quote(pattern) +
          " is not a regular expression (of RE2): " + printable(compiled->error(), kLongestQuote));
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

NameRenames::NameRenames(const std::vector<Rename>& renames) : patterns_(patternsOf(renames)) {
  for (std::size_t k = 0; k < renames.size(); ++k) {
    const std::string& name = renames[k].name;
    std::string problem;
    if (name.empty() || name[0] != '/') {
      problem = "must begin with a slash";
    } else if (name.size() > kLongestName || !isPrintable(name)) {
      problem = "is too long, is no UTF-8, or has control characters";
    } else if (!patterns_.all()[k]->CheckRewriteString(name, &problem)) {
      problem = "does not fit its pattern (" + printable(problem, kLongestQuote) + ")";
    } else {
      names_.push_back(name);
      continue;
    }
    throw std::invalid_argument("encoding: the name " + quote(name) + " that takes the place of " +
                                quote(renames[k].pattern) + " " + problem);
  }
}

std::string NameRenames::apply(const std::string& name) const {
  const std::size_t rule = patterns_.firstThatMatches(name);
  if (rule == names_.size()) {
    return name;
  }
  const re2::RE2& pattern = *patterns_.all()[rule];
  std::array<re2::StringPiece, kMostGroups> groups;
  const int wanted = 1 + re2::RE2::MaxSubmatch(names_[rule]);
  std::string renamed;
  const bool matches = NamePatterns::matches(pattern, name, groups.data(), wanted) &&
                       pattern.Rewrite(&renamed, names_[rule], groups.data(), wanted);
  return matches ? resolvedName(renamed) : name;
}

}  // namespace self_awareness::ros1
