#include "name_renames.h"

#include <re2/stringpiece.h>

#include <array>
#include <stdexcept>

#include "self_awareness/ros/stable_name.h"
#include "text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kLongestQuotedRule = 200;  // of a rule in an error [bytes]
constexpr int kMostGroups = 10;                  // the whole name, and \1 to \9

std::vector<std::string> patternsOf(const std::vector<Rename>& renames) {
  std::vector<std::string> patterns;
  for (const Rename& rename : renames) {
    patterns.push_back(rename.pattern);
  }
  return patterns;
}

}  // namespace

NameRenames::NameRenames(const std::vector<Rename>& renames) : patterns_(patternsOf(renames)) {
  for (std::size_t k = 0; k < renames.size(); ++k) {
    const std::string& name = renames[k].name;
    std::string problem;
    if (name.empty() || name[0] != '/') {
      problem = "must begin with a slash";
    } else if (name.size() > kLongestName || !isPrintable(name)) {
      problem = "is too long, is no UTF-8, or has control characters";
    } else if (!patterns_.all()[k]->CheckRewriteString(name, &problem)) {
      problem = "does not fit its pattern (" + printable(problem, kLongestQuotedRule) + ")";
    } else {
      names_.push_back(name);
      continue;
    }
    throw std::invalid_argument("encoding: the name '" + printable(name, kLongestQuotedRule) +
                                "' that takes the place of '" +
                                printable(renames[k].pattern, kLongestQuotedRule) + "' " +
                                problem);
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
