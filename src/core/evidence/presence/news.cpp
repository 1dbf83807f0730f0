#include "core/evidence/presence/news.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "core/verdict/name_list.h"
#include "self_awareness/core/stream/listed.h"

namespace self_awareness::core::evidence {
namespace {

constexpr std::size_t kMostNamed = 3;

// Levels of diagnostic_msgs/DiagnosticStatus below ERROR are the node's own business.
const std::string kLevel = "status.level";
const std::set<std::string> kLevelsBelowError{"0", "1"};

std::size_t recordingsWith(EventId id, const Statistics& counts) {
  const auto& all = counts.recordings();
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [id](const auto& each) {
    return id < each.firsts.size() && each.firsts[id] >= 0;
  }));
}

std::vector<std::string> without(const std::set<std::string>& all,
                                 const std::set<std::string>& some) {
  std::vector<std::string> rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

/// What a list has that no other one has, or lacks that all others have, in words.
std::string difference(const Listed& list, const std::vector<std::set<std::string>>& others) {
  std::set<std::string> any;
  std::set<std::string> each = others.front();
  for (const std::set<std::string>& other : others) {
    any.insert(other.begin(), other.end());
    std::set<std::string> both;
    std::set_intersection(each.begin(), each.end(), other.begin(), other.end(),
                          std::inserter(both, both.end()));
    each = both;
  }
  const std::vector<std::string> missing = without(each, list.values);
  const std::vector<std::string> added = without(list.values, any);
  if (!missing.empty() && (added.empty() || list.values.size() > 1)) {
    return "without " + listed(missing, kMostNamed) + " (" + list.field + ")";
  }
  if (!added.empty()) {
    return "with " + list.field + "=" + listed(added, kMostNamed);
  }
  return "with other " + list.field + " together";
}

Reason newOf(const EventType& type, const std::string& what) {
  Reason reason;
  reason.kind = Kind::kStranger;
  reason.topics = {type.scope};
  reason.words = type.source + (type.source.empty() ? "somebody sends " : " sends ") + type.scope +
                 " " + what + ", as never in training";
  return reason;
}

}  // namespace

News::News(const Model& model, std::shared_ptr<const Vocabulary> heard)
    : heard_(std::move(heard)) {
  for (EventId id = 0; id < model.size(); ++id) {
    const EventType& type = model.vocabulary().at(id);
    const std::optional<EventType> any = withoutValue(type);
    if (const std::optional<Listed> list = listedBy(type)) {
      Lists& lists = lists_[{any.value(), list->field}];
      const std::size_t recordings = recordingsWith(id, model.statistics());
      lists.fewest_recordings =
          lists.all.empty() ? recordings : std::min(lists.fewest_recordings, recordings);
      lists.all.push_back(list->values);
    } else if (any && model.vocabulary().isMessage(id)) {
      valued_.insert(*any);
    }
  }
}

bool News::isNewList(EventId id) const {
  return heard_ && heard_->tellsList(id) && reasonOf(id);
}

std::optional<Reason> News::reasonOf(EventId id) const {
  if (!heard_ || id >= heard_->size()) {
    return std::nullopt;
  }
  const EventType& type = heard_->at(id);
  const std::optional<EventType> any = withoutValue(type);
  if (!any) {
    return std::nullopt;
  }
  if (!heard_->tellsList(id)) {
    return valued_.count(*any) == 0 ? std::nullopt
                                    : std::optional(newOf(type, "with " + valueOf(type)));
  }
  const Listed list = listedBy(type).value();
  const auto known = lists_.find({*any, list.field});
  const bool invents =
      list.values.empty() || known == lists_.end() ||
      known->second.fewest_recordings < 2 ||  // it may not come again
      std::count(known->second.all.begin(), known->second.all.end(), std::set<std::string>()) > 0;
  const bool is_usual =
      list.field == kLevel && std::includes(kLevelsBelowError.begin(), kLevelsBelowError.end(),
                                            list.values.begin(), list.values.end());
  if (invents || is_usual) {
    return std::nullopt;
  }
  return newOf(type, difference(list, known->second.all));
}

}  // namespace self_awareness::core::evidence
